//! Kinds of values: scalars, vectors and rotations.

use super::rotation::Factor;
use super::vector::Vector;
use crate::ast::Syntax;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimensions {
    /// Components x and y; z is stored as 0.
    Two,
    Three,
}

impl Dimensions {
    pub fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }
}

#[derive(Clone, Debug)]
pub enum Value {
    Scalar(Syntax),
    /// Components along the fixed axes.
    Vector(Vector, Dimensions),
    /// Product of rotations; the first factor is on the left.
    Rotation(Vec<Factor>, Dimensions),
}

impl Value {
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Scalar(_) => "a scalar",
            Self::Vector(_, Dimensions::Two) => "a vector of 2 components",
            Self::Vector(_, Dimensions::Three) => "a vector",
            Self::Rotation(..) => "a rotation",
        }
    }
}
