//! Operations of the graph's nodes, their shapes and dependences.

use eomgen_model_spec::ids::{CoordinateId, FieldId, InputId, ParameterId, StateId};
use eomgen_model_spec::model::Function;

use crate::symbolic::arguments::Arguments;
pub use crate::symbolic::variable::{Argument, Variable};

/// Index of a node in a graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub(crate) u32);

impl NodeId {
    /// Returns the index in the graph.
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// Index space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Space {
    /// Modes of a field.
    Modes(FieldId),
    /// Quadrature nodes of a field.
    Nodes(FieldId),
}

/// Shape of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// One number.
    Scalar,
    /// One number for each index.
    Vector(Space),
    /// One number for each pair of indices (rows, columns).
    Matrix(Space, Space),
}

/// Floating-point number with equality and hash of its bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Bits(u64);

impl Bits {
    /// Converts a number; -0 becomes 0, so both are the same constant.
    pub fn new(value: f64) -> Self {
        Self((value + 0.0).to_bits())
    }

    /// Returns the number.
    pub fn value(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// Operation of a node.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// Number.
    Constant(Bits),
    /// Parameter, independent or derived.
    Parameter(ParameterId),
    /// Generalised coordinate.
    Coordinate(CoordinateId),
    /// Rate of a generalised coordinate.
    Rate(CoordinateId),
    /// First-order state.
    State(StateId),
    /// Input.
    Input(InputId),
    /// Time.
    Time,
    /// Modal coordinates of a field, a vector.
    ModeCoordinates(FieldId),
    /// Rates of a field's modal coordinates, a vector.
    ModeRates(FieldId),
    /// Component of an argument for a variable.
    Argument(Argument, Variable),
    /// Table of constants: a vector or a matrix.
    Table(usize),
    /// Linear combination with numeric factors, in the order of the nodes. A constant term is a factor of the
    /// node 1.
    Sum(Box<[(Bits, NodeId)]>),
    /// Product of integer powers, in the order of the nodes.
    Product(Box<[(NodeId, i32)]>),
    /// Function applied element by element.
    Call(Function, Arguments<NodeId>),
    /// Real power `base^exponent`; the exponent is not an integer constant.
    Power(NodeId, NodeId),
    /// `if a > b { then } else { otherwise }`.
    Select {
        /// Left side of the comparison.
        a: NodeId,
        /// Right side of the comparison.
        b: NodeId,
        /// Result if a > b.
        then: NodeId,
        /// Result otherwise.
        otherwise: NodeId,
        /// True if a = b is a switching surface; false if both results agree near a = b.
        is_switch: bool,
    },
    /// Sum of a vector's elements.
    Total(NodeId),
    /// Matrix, or its transpose, times a vector.
    Apply {
        /// Matrix.
        matrix: NodeId,
        /// True to use the transpose.
        transposed: bool,
        /// Vector.
        vector: NodeId,
    },
    /// left^T diag(weight) right, for tables over quadrature nodes.
    Gram {
        /// Matrix, quadrature nodes x modes.
        left: NodeId,
        /// Vector over the quadrature nodes.
        weight: NodeId,
        /// Matrix, quadrature nodes x modes.
        right: NodeId,
    },
    /// Diagonal of left^T diag(weight) right.
    GramDiagonal {
        /// Matrix, quadrature nodes x modes.
        left: NodeId,
        /// Vector over the quadrature nodes.
        weight: NodeId,
        /// Matrix, quadrature nodes x modes.
        right: NodeId,
    },
    /// Matrix assembled from a diagonal, outer products u v^T and matrices with scaled rows and columns.
    Assemble(Box<Assembly>),
    /// Lower Cholesky factor of a symmetric positive definite matrix; NaN if a pivot is not positive.
    Cholesky(NodeId),
    /// Solution of a system with a given Cholesky factor (first operand). The right-hand side is a vector, a scalar
    /// for all elements, or a matrix.
    CholeskySolve(NodeId, NodeId),
    /// Reciprocal of a pivot, NaN if it is not positive.
    PivotReciprocal(NodeId),
}

/// Parts of an assembled matrix.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Assembly {
    /// Index space of the rows.
    pub rows: Space,
    /// Index space of the columns.
    pub columns: Space,
    /// Diagonal, a vector or a scalar; only for a square matrix.
    pub diagonal: Option<NodeId>,
    /// Outer products u v^T.
    pub outer: Vec<(NodeId, NodeId)>,
    /// Terms diag(row) matrix diag(column), possibly with the transposed matrix.
    pub matrices: Vec<ScaledMatrix>,
}

/// Term diag(row) matrix diag(column).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ScaledMatrix {
    /// Factors of the rows: scalar or vector.
    pub row: NodeId,
    /// Matrix.
    pub matrix: NodeId,
    /// True to use the transpose.
    pub transposed: bool,
    /// Factors of the columns: scalar or vector.
    pub column: NodeId,
}

/// Kinds of quantities that a node depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dependence(u8);

impl Dependence {
    pub(crate) const NONE: Self = Self(0);
    pub(crate) const PARAMETER: Self = Self(1);
    pub(crate) const COORDINATE: Self = Self(2);
    pub(crate) const RATE: Self = Self(4);
    pub(crate) const INPUT: Self = Self(8);
    pub(crate) const TIME: Self = Self(16);
    pub(crate) const ARGUMENT: Self = Self(32);
    pub(crate) const STATE: Self = Self(64);

    pub(crate) const fn join(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns true if the node depends on one of `kinds`.
    pub fn has(self, kinds: Self) -> bool {
        self.0 & kinds.0 != 0
    }

    /// Returns true if the node depends only on parameters and constants.
    pub fn is_parameter_only(self) -> bool {
        self.0 & !Self::PARAMETER.0 == 0
    }
}

impl Assembly {
    pub(crate) fn operands(&self) -> Vec<NodeId> {
        let mut all: Vec<NodeId> = self.diagonal.into_iter().collect();
        all.extend(self.outer.iter().flat_map(|(u, v)| [*u, *v]));
        all.extend(
            self.matrices
                .iter()
                .flat_map(|m| [m.row, m.matrix, m.column]),
        );
        all
    }
}
