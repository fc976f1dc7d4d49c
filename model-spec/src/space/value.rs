//! What an expression of a specification is worth: a scalar, a vector or a rotation.

use super::rotation::Factor;
use super::vector::Vector;
use crate::ast::Syntax;

/// How many components a vector has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimensions {
    /// x and y; z is kept as 0.
    Two,
    /// x, y and z.
    Three,
}

impl Dimensions {
    /// As a number.
    pub fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }
}

/// What an expression is worth.
#[derive(Clone, Debug)]
pub enum Value {
    /// A number.
    Scalar(Syntax),
    /// Components along the fixed axes.
    Vector(Vector, Dimensions),
    /// A product of rotations, the first on the left.
    Rotation(Vec<Factor>, Dimensions),
}

impl Value {
    /// What it is, for a message.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Scalar(_) => "a scalar",
            Self::Vector(_, Dimensions::Two) => "a vector of 2 components",
            Self::Vector(_, Dimensions::Three) => "a vector",
            Self::Rotation(..) => "a rotation",
        }
    }
}
