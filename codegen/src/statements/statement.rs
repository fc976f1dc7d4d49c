//! Statements of a stage.

use super::expression::{Array, Expression};
use super::index::{Index, Span};

/// Target of an assignment.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Name of an array or of a flag of the stage.
    pub name: String,
    /// Indices of the element; empty for a flag.
    pub indices: Vec<Index>,
}

impl Place {
    /// Refers to an element of an array of the stage.
    pub fn new(name: impl Into<String>, indices: impl Into<Vec<Index>>) -> Self {
        Self {
            name: name.into(),
            indices: indices.into(),
        }
    }

    /// Returns the expression that reads the target.
    pub fn value(&self) -> Expression {
        Expression::element(&*self.name, &*self.indices)
    }
}

/// Statement of a stage.
#[derive(Clone, Debug, PartialEq)]
pub enum Statement {
    /// Definition of a named number.
    Let(String, Expression),
    /// Definition of an array of zeros with one or two dimensions.
    Zeros(String, Vec<usize>),
    /// Definition of a flag with the value true.
    Flag(String),
    /// Assignment to an existing element or flag.
    Assign(Place, Expression),
    /// Loop over the values of a variable.
    Loop {
        /// Variable.
        index: &'static str,
        /// Values.
        span: Span,
        /// Statements for each value.
        lines: Vec<Self>,
    },
    /// Definition of a number less a sum of products. The products are subtracted in the order of a loop.
    Remainder {
        /// Name of the remainder.
        name: &'static str,
        /// Number before the first subtraction.
        first: Expression,
        /// Variable of the loop.
        index: &'static str,
        /// Values of the variable.
        span: Span,
        /// Product for each value.
        product: Expression,
    },
    /// Sum of elements i, in the order that [`Op::Total`](crate::program::Op::Total) defines.
    Sum {
        /// Name of the sum.
        name: String,
        /// Number of elements.
        length: usize,
        /// Element i.
        element: Expression,
    },
    /// Lower Cholesky factor of a matrix.
    Cholesky {
        /// Name of the factor.
        name: String,
        /// Matrix.
        matrix: Array,
        /// Number of rows.
        rows: usize,
    },
    /// Solution with a Cholesky factor for a vector or for the columns of a matrix.
    CholeskySolve {
        /// Name of the solution.
        name: String,
        /// Factor.
        factor: Array,
        /// Right-hand side.
        right: Array,
        /// Number of rows of the factor.
        rows: usize,
        /// Number of columns if the right-hand side is a matrix.
        columns: Option<usize>,
    },
}

impl Statement {
    /// Returns the name that the statement defines.
    pub fn defined(&self) -> Option<&str> {
        match self {
            Self::Let(name, _)
            | Self::Zeros(name, _)
            | Self::Sum { name, .. }
            | Self::Cholesky { name, .. }
            | Self::CholeskySolve { name, .. } => Some(name),
            Self::Flag(_) | Self::Assign(..) | Self::Loop { .. } | Self::Remainder { .. } => None,
        }
    }

    /// Builds a loop over i with one statement.
    pub fn loop_over_elements(length: usize, statement: Self) -> Self {
        Self::loop_over("i", length, vec![statement])
    }

    /// Builds a loop.
    pub fn loop_over(index: &'static str, length: usize, lines: Vec<Self>) -> Self {
        Self::Loop {
            index,
            span: Span::between(0, length),
            lines,
        }
    }

    /// Builds the addition of a summand to the value of a target.
    pub fn add_to(place: Place, summand: &Expression) -> Self {
        let sum = Expression::add(&place.value(), summand);
        Self::Assign(place, sum)
    }
}
