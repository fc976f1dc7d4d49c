//! Values of a program and their operations.

use eomgen_model_spec::function::Function;
use eomgen_model_spec::ids::{CoordinateId, FieldId, InputId, StateId};

use crate::symbolic::arguments::Arguments;
use crate::symbolic::variable::{Argument, Variable};

/// Index of a value of a [`Program`](super::Program).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ValueId(pub(crate) usize);

impl ValueId {
    /// Returns the index in the program's list.
    pub fn index(self) -> usize {
        self.0
    }
}

/// Size of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Extent {
    /// One number.
    Scalar,
    /// One number for each index.
    Vector(usize),
    /// Number of rows and columns; elements are stored row by row.
    Matrix(usize, usize),
}

impl Extent {
    /// Returns the number of elements.
    pub fn length(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector(n) => n,
            Self::Matrix(rows, columns) => rows * columns,
        }
    }

    /// Returns the length of a row: 1 except for a matrix.
    pub fn columns(self) -> usize {
        match self {
            Self::Scalar | Self::Vector(_) => 1,
            Self::Matrix(_, columns) => columns,
        }
    }
}

/// Number of partial sums in a long sum. It hides the latency of additions and fills the widest SIMD registers.
pub const PARTIAL_SUMS: usize = 8;

/// Operation that computes a value.
#[derive(Clone, Debug, PartialEq)]
pub enum Op {
    /// Number.
    Constant(f64),
    /// Table of numbers, by its index in [`Program::tables`](super::Program::tables).
    Table(usize),
    /// Independent parameter, by its index in [`Program::parameters`](super::Program::parameters).
    Parameter(usize),
    /// Coordinate of the state.
    Coordinate(CoordinateId),
    /// Rate of a coordinate.
    Rate(CoordinateId),
    /// Modal coordinates of a field.
    ModeCoordinates(FieldId),
    /// Rates of a field's modal coordinates.
    ModeRates(FieldId),
    /// First-order state.
    State(StateId),
    /// Input.
    Input(InputId),
    /// Time.
    Time,
    /// Component of an argument for a variable.
    Argument(Argument, Variable),
    /// -a
    Negate(ValueId),
    /// a + b
    Add(ValueId, ValueId),
    /// a - b
    Subtract(ValueId, ValueId),
    /// a b
    Multiply(ValueId, ValueId),
    /// a / b
    Divide(ValueId, ValueId),
    /// a^b
    Power(ValueId, ValueId),
    /// Function of one or two arguments.
    Call(Function, Arguments<ValueId>),
    /// `if a > b { then } else { otherwise }`
    Select {
        /// Left side of the comparison.
        a: ValueId,
        /// Right side of the comparison.
        b: ValueId,
        /// Result if a > b.
        then: ValueId,
        /// Result otherwise, also if a or b is NaN.
        otherwise: ValueId,
    },
    /// 1/a if a > 0, else NaN.
    PivotReciprocal(ValueId),
    /// Sum of the elements; 0 for an empty vector. Each of the first [`PARTIAL_SUMS`] elements starts a partial sum,
    /// to which every eighth following element is added in order. The partial sums are then added by pairwise
    /// summation; an unpaired last number is kept for the next round.
    Total(ValueId),
    /// Product of a matrix, or its transpose, and a vector. Each element is a sum that starts from 0, in the order of
    /// the vector's elements.
    Apply {
        /// Matrix.
        matrix: ValueId,
        /// True to use the transpose.
        transposed: bool,
        /// Vector.
        vector: ValueId,
    },
    /// left^T diag(weight) right: element (r, c) is the sum over g of (left_gr * weight_g) * right_gc.
    Gram {
        /// Matrix, quadrature nodes x rows.
        left: ValueId,
        /// Vector over the quadrature nodes.
        weight: ValueId,
        /// Matrix, quadrature nodes x columns.
        right: ValueId,
    },
    /// Diagonal of left^T diag(weight) right.
    GramDiagonal {
        /// Matrix, quadrature nodes x modes.
        left: ValueId,
        /// Vector over the quadrature nodes.
        weight: ValueId,
        /// Matrix, quadrature nodes x modes.
        right: ValueId,
    },
    /// Matrix with element (r, c) = 0 + diagonal + each outer product u_r v_c + each (row_r * matrix_rc) *
    /// column_c, added in this order.
    Assemble {
        /// Diagonal.
        diagonal: Option<ValueId>,
        /// Outer products.
        outer: Vec<(ValueId, ValueId)>,
        /// Scaled matrices.
        matrices: Vec<ScaledValue>,
    },
    /// Lower Cholesky factor, row by row; the upper part is 0. A pivot that is not positive gives NaN.
    Cholesky(ValueId),
    /// Solution of a system with a Cholesky factor: forward, then backward substitution, column by column.
    CholeskySolve(ValueId, ValueId),
}

/// Scaled matrix diag(row) matrix diag(column).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledValue {
    /// Factors of the rows.
    pub row: ValueId,
    /// Matrix.
    pub matrix: ValueId,
    /// True to use the transpose.
    pub transposed: bool,
    /// Factors of the columns.
    pub column: ValueId,
}

impl Op {
    /// Returns the operands.
    pub fn operands(&self) -> Vec<ValueId> {
        match self {
            Self::Constant(_)
            | Self::Table(_)
            | Self::Parameter(_)
            | Self::Coordinate(_)
            | Self::Rate(_)
            | Self::ModeCoordinates(_)
            | Self::ModeRates(_)
            | Self::State(_)
            | Self::Input(_)
            | Self::Time
            | Self::Argument(..) => Vec::new(),
            Self::Negate(a) | Self::PivotReciprocal(a) | Self::Total(a) | Self::Cholesky(a) => {
                vec![*a]
            }
            Self::Add(a, b)
            | Self::Subtract(a, b)
            | Self::Multiply(a, b)
            | Self::Divide(a, b)
            | Self::Power(a, b)
            | Self::CholeskySolve(a, b) => vec![*a, *b],
            Self::Call(_, arguments) => arguments.to_vec(),
            Self::Select {
                a,
                b,
                then,
                otherwise,
            } => vec![*a, *b, *then, *otherwise],
            Self::Apply { matrix, vector, .. } => vec![*matrix, *vector],
            Self::Gram {
                left,
                weight,
                right,
            }
            | Self::GramDiagonal {
                left,
                weight,
                right,
            } => vec![*left, *weight, *right],
            Self::Assemble {
                diagonal,
                outer,
                matrices,
            } => diagonal
                .iter()
                .copied()
                .chain(outer.iter().flat_map(|(u, v)| [*u, *v]))
                .chain(matrices.iter().flat_map(|m| [m.row, m.matrix, m.column]))
                .collect(),
        }
    }
}

/// Value of a program.
#[derive(Clone, Debug)]
pub struct Value {
    /// Operation.
    pub op: Op,
    /// Extent.
    pub extent: Extent,
    /// True if the value depends only on parameters and constants; `prepare` computes it once per parameter set.
    pub parameter_only: bool,
    /// Name in the specification, if there is one.
    pub name: Option<String>,
}
