//! The values of a program: what each holds, how it is computed, and from which.

use eomgen_model_spec::ids::{CoordinateId, FieldId, InputId, StateId};
use eomgen_model_spec::model::Function;

use crate::symbolic::arguments::Arguments;
use crate::symbolic::graph::{Argument, Variable};

/// A value of a [`Program`](super::Program).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ValueId(pub(crate) usize);

impl ValueId {
    /// The value's place in the program's list.
    pub fn index(self) -> usize {
        self.0
    }
}

/// How many numbers a value holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Extent {
    /// One.
    Scalar,
    /// One per index.
    Vector(usize),
    /// Rows times columns, row by row.
    Matrix(usize, usize),
}

impl Extent {
    /// How many numbers.
    pub fn length(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector(n) => n,
            Self::Matrix(rows, columns) => rows * columns,
        }
    }

    /// How many numbers stand in a row: one, but for a matrix.
    pub fn columns(self) -> usize {
        match self {
            Self::Scalar | Self::Vector(_) => 1,
            Self::Matrix(_, columns) => columns,
        }
    }
}

/// How many partial sums a long sum has: enough that an addition need not wait for the one
/// before it, and for the widest vectors.
pub const PARTIAL_SUMS: usize = 8;

/// How a value is computed.
#[derive(Clone, Debug, PartialEq)]
pub enum Op {
    /// A number.
    Constant(f64),
    /// A table of numbers, by its place in [`Program::tables`](super::Program::tables).
    Table(usize),
    /// An independent parameter, by its place in [`Program::parameters`](super::Program::parameters).
    Parameter(usize),
    /// A coordinate of the state.
    Coordinate(CoordinateId),
    /// The rate of a coordinate.
    Rate(CoordinateId),
    /// A field's mode coordinates.
    ModeCoordinates(FieldId),
    /// The rates of a field's mode coordinates.
    ModeRates(FieldId),
    /// A state of first order.
    State(StateId),
    /// An input.
    Input(InputId),
    /// The time.
    Time,
    /// What an argument holds for a variable.
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
    /// A function of one or two arguments.
    Call(Function, Arguments<ValueId>),
    /// `if a > b { then } else { otherwise }`
    Select {
        /// Compared.
        a: ValueId,
        /// Compared with.
        b: ValueId,
        /// Value where a > b.
        then: ValueId,
        /// Value elsewhere, also where a or b is NaN.
        otherwise: ValueId,
    },
    /// 1/a where a > 0, NaN elsewhere.
    PivotReciprocal(ValueId),
    /// The sum of the elements, 0 of none. The first [`PARTIAL_SUMS`] of them each begin a
    /// partial sum, to which every eighth element from there on is added in order. Then
    /// neighbours are added in pairs until one number is left; of an odd count the last
    /// passes on to the next round.
    Total(ValueId),
    /// Matrix (or its transpose) times vector; each element from 0 and the first product to
    /// the last.
    Apply {
        /// The matrix.
        matrix: ValueId,
        /// Whether its transpose is meant.
        transposed: bool,
        /// The vector.
        vector: ValueId,
    },
    /// left^T diag(weight) right: element (r, c) sums (left_gr * weight_g) * right_gc.
    Gram {
        /// Matrix nodes x rows.
        left: ValueId,
        /// Vector over the nodes.
        weight: ValueId,
        /// Matrix nodes x columns.
        right: ValueId,
    },
    /// The diagonal of the same.
    GramDiagonal {
        /// Matrix nodes x modes.
        left: ValueId,
        /// Vector over the nodes.
        weight: ValueId,
        /// Matrix nodes x modes.
        right: ValueId,
    },
    /// Element (r, c): the diagonal, then each outer product u_r v_c, then each
    /// (row_r * matrix_rc) * column_c, added in this order to 0.
    Assemble {
        /// The diagonal.
        diagonal: Option<ValueId>,
        /// Outer products.
        outer: Vec<(ValueId, ValueId)>,
        /// Scaled matrices.
        matrices: Vec<ScaledValue>,
    },
    /// Lower Cholesky factor, row by row; the upper part is 0. A pivot that is not
    /// positive gives NaN.
    Cholesky(ValueId),
    /// Forward, then backward substitution with a Cholesky factor, column by column.
    CholeskySolve(ValueId, ValueId),
}

/// diag(row) matrix diag(column)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledValue {
    /// Scales the rows.
    pub row: ValueId,
    /// The matrix.
    pub matrix: ValueId,
    /// Whether its transpose is meant.
    pub transposed: bool,
    /// Scales the columns.
    pub column: ValueId,
}

impl Op {
    /// The values it reads.
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

/// One value.
#[derive(Clone, Debug)]
pub struct Value {
    /// How it is computed.
    pub op: Op,
    /// How many numbers it holds.
    pub extent: Extent,
    /// Whether it depends on parameters and constants alone: it belongs to the stage that is
    /// computed once for a set of parameters.
    pub parameter_only: bool,
    /// The specification's name for it, if it has one.
    pub name: Option<String>,
}
