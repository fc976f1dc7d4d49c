//! Statements: what a stage does, one after the other. A backend prints them.

use super::expression::{Array, Expression};
use super::index::Index;

/// Where a number is put.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Name of an array of the stage, or of a flag.
    pub name: String,
    /// None of a flag.
    pub indices: Vec<Index>,
}

impl Place {
    /// An element of an array of the stage.
    pub fn new(name: impl Into<String>, indices: impl Into<Vec<Index>>) -> Self {
        Self {
            name: name.into(),
            indices: indices.into(),
        }
    }

    /// What stands there.
    pub fn value(&self) -> Expression {
        Expression::element(&*self.name, &*self.indices)
    }
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub enum Statement {
    /// A named number.
    Let(String, Expression),
    /// An array of zeros, of one or two dimensions.
    Zeros(String, Vec<usize>),
    /// A flag that holds so far.
    Flag(String),
    /// A number put where one stands.
    Assign(Place, Expression),
    /// The lines for each value of a variable from 0 on.
    Loop {
        /// The variable.
        index: &'static str,
        /// How many values.
        length: usize,
        /// What is done for each.
        lines: Vec<Self>,
    },
    /// The named sum of elements i, in the order that [`Op::Total`](crate::program::Op::Total)
    /// defines.
    Sum {
        /// Name of the sum.
        name: String,
        /// How many.
        length: usize,
        /// Element i.
        element: Expression,
    },
    /// The named lower Cholesky factor of a matrix.
    Cholesky {
        /// Name of the factor.
        name: String,
        /// The matrix.
        matrix: Array,
        /// Its rows.
        rows: usize,
    },
    /// The named solution with a Cholesky factor, of a vector or of the columns of a matrix.
    CholeskySolve {
        /// Name of the solution.
        name: String,
        /// The factor.
        factor: Array,
        /// The right side.
        right: Array,
        /// Rows of the factor.
        rows: usize,
        /// Columns of the right side if it is a matrix.
        columns: Option<usize>,
    },
}

impl Statement {
    /// A loop over i with one statement in it.
    pub fn each(length: usize, statement: Self) -> Self {
        Self::looped("i", length, vec![statement])
    }

    /// A loop.
    pub fn looped(index: &'static str, length: usize, lines: Vec<Self>) -> Self {
        Self::Loop {
            index,
            length,
            lines,
        }
    }

    /// An addition to what stands at a place.
    pub fn add_to(place: Place, summand: &Expression) -> Self {
        let sum = Expression::add(&place.value(), summand);
        Self::Assign(place, sum)
    }
}
