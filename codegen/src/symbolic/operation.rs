//! What the nodes of the graph compute, their shapes, and what they depend on.

use eomgen_model_spec::ids::{CoordinateId, FieldId, InputId, ParameterId, StateId};
use eomgen_model_spec::model::Function;

use crate::symbolic::arguments::Arguments;

/// A node of a graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub(crate) u32);

/// An index space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Space {
    /// The modes of a field.
    Modes(FieldId),
    /// The quadrature nodes along a field.
    Nodes(FieldId),
}

/// The shape of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// One number.
    Scalar,
    /// One number per index.
    Vector(Space),
    /// One number per pair of indices (rows, columns).
    Matrix(Space, Space),
}

/// A floating-point number that can be hashed: compared by its bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Bits(u64);

impl Bits {
    /// The number as bits; -0 becomes 0 so that both are one constant.
    pub fn new(value: f64) -> Self {
        Self((value + 0.0).to_bits())
    }

    /// The number.
    pub fn value(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// What the equations move with or are driven by, one by one or by the modes of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Variable {
    /// A generalised coordinate.
    Coordinate(CoordinateId),
    /// A field's mode coordinates.
    ModeCoordinates(FieldId),
    /// The rate of a generalised coordinate.
    Rate(CoordinateId),
    /// The rates of a field's mode coordinates.
    ModeRates(FieldId),
    /// A state of first order.
    State(StateId),
    /// An input.
    Input(InputId),
    /// A parameter; in a program, a place among the independent ones.
    Parameter(ParameterId),
    /// The time.
    Time,
}

/// What some outputs are called with besides state and inputs: a number for each
/// of these variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Argument {
    /// Accelerations, in the order of the coordinates.
    Accelerations,
    /// A direction in the space of states and inputs.
    Direction,
    /// A direction in the space of time, state, inputs and independent parameters.
    PointDirection,
    /// A weight for each rate of the state, in the order of the state.
    Weights,
}

/// What a node computes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// A number.
    Constant(Bits),
    /// A parameter, independent or derived.
    Parameter(ParameterId),
    /// A generalised coordinate.
    Coordinate(CoordinateId),
    /// The rate of a generalised coordinate.
    Rate(CoordinateId),
    /// A state of first order.
    State(StateId),
    /// A signal supplied at run time.
    Input(InputId),
    /// The time.
    Time,
    /// A field's mode coordinates, a vector.
    ModeCoordinates(FieldId),
    /// The rates of a field's mode coordinates, a vector.
    ModeRates(FieldId),
    /// What an argument holds for a variable.
    Argument(Argument, Variable),
    /// A table of constants: a vector or a matrix.
    Table(usize),
    /// A linear combination with numeric factors, in the order of the nodes; the
    /// constant 1 as a node carries a constant term.
    Sum(Box<[(Bits, NodeId)]>),
    /// A product of integer powers, in the order of the nodes.
    Product(Box<[(NodeId, i32)]>),
    /// A function applied element by element.
    Call(Function, Arguments<NodeId>),
    /// A real power `base^exponent` with an exponent that is no integer literal.
    Power(NodeId, NodeId),
    /// `if a > b { then } else { otherwise }`.
    Select {
        /// Compared.
        a: NodeId,
        /// Compared with.
        b: NodeId,
        /// Value where a > b.
        then: NodeId,
        /// Value elsewhere.
        otherwise: NodeId,
    },
    /// The sum of a vector's elements.
    Total(NodeId),
    /// A matrix, or its transpose, times a vector.
    Apply {
        /// The matrix.
        matrix: NodeId,
        /// Whether its transpose is meant.
        transposed: bool,
        /// The vector.
        vector: NodeId,
    },
    /// left^T diag(weight) right, for tables over quadrature nodes.
    Gram {
        /// Matrix nodes x modes.
        left: NodeId,
        /// Vector over the nodes.
        weight: NodeId,
        /// Matrix nodes x modes.
        right: NodeId,
    },
    /// The diagonal of left^T diag(weight) right.
    GramDiagonal {
        /// Matrix nodes x modes.
        left: NodeId,
        /// Vector over the nodes.
        weight: NodeId,
        /// Matrix nodes x modes.
        right: NodeId,
    },
    /// A matrix put together from a diagonal, outer products u v^T and
    /// row-scaled and column-scaled matrices.
    Assemble(Box<Assembly>),
    /// The lower Cholesky factor of a symmetric positive definite matrix. A pivot that
    /// is not positive makes the factor NaN.
    Cholesky(NodeId),
    /// The solution of a system by its Cholesky factor; the right side is a vector, a scalar
    /// that stands for one, or a matrix.
    CholeskySolve(NodeId, NodeId),
    /// The reciprocal of a pivot, NaN where it is not positive.
    PivotReciprocal(NodeId),
}

/// The parts of an assembled matrix.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Assembly {
    /// Index space of the rows.
    pub rows: Space,
    /// Index space of the columns.
    pub columns: Space,
    /// The diagonal, a vector or a scalar; only of a square matrix.
    pub diagonal: Option<NodeId>,
    /// Outer products u v^T.
    pub outer: Vec<(NodeId, NodeId)>,
    /// diag(row) matrix diag(column), the matrix transposed if so said.
    pub matrices: Vec<ScaledMatrix>,
}

/// diag(row) matrix diag(column).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ScaledMatrix {
    /// Scales the rows: scalar or vector.
    pub row: NodeId,
    /// The matrix.
    pub matrix: NodeId,
    /// Whether its transpose is meant.
    pub transposed: bool,
    /// Scales the columns: scalar or vector.
    pub column: NodeId,
}

/// What a node depends on.
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

    /// Whether it depends on anything in `kinds`.
    pub fn has(self, kinds: Self) -> bool {
        self.0 & kinds.0 != 0
    }

    /// Whether it depends on nothing but parameters and constants.
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
