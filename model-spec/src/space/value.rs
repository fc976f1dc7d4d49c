//! Kinds of values: scalars, vectors and rotations.

use super::rotation::Factor;
use super::vector::Vector;
use crate::ast::Syntax;

/// Number of components of a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimensions {
    /// x and y; z is stored as 0.
    Two,
    /// x, y and z.
    Three,
}

impl Dimensions {
    /// Returns the number of components.
    pub fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }
}

/// Value of an expression.
#[derive(Clone, Debug)]
pub enum Value {
    /// Scalar.
    Scalar(Syntax),
    /// Components along the fixed axes.
    Vector(Vector, Dimensions),
    /// Product of rotations, the first on the left.
    Rotation(Vec<Factor>, Dimensions),
}

impl Value {
    /// Returns the kind, for a message.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Scalar(_) => "a scalar",
            Self::Vector(_, Dimensions::Two) => "a vector of 2 components",
            Self::Vector(_, Dimensions::Three) => "a vector",
            Self::Rotation(..) => "a rotation",
        }
    }
}
