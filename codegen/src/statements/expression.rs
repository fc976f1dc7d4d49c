//! Expressions of the statements: trees over arguments, coefficients and computed values. IEEE 754 defines the result
//! of each operation.

use super::index::Index;
use crate::program::Extent;

/// Binary operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// a + b
    Add,
    /// a - b
    Subtract,
    /// a b
    Multiply,
    /// a / b
    Divide,
}

/// Struct with named numbers that a stage reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArgumentStruct {
    /// Prepared coefficients.
    Coefficients,
    /// Parameters from which the coefficients are prepared.
    Parameters,
    /// Inputs at the time of the call.
    Inputs,
    /// Direction of the inputs.
    InputDirection,
    /// Quantities that a controller measures.
    Measured,
    /// Times and states of a controller.
    Memory,
}

/// Array that an expression reads.
#[derive(Clone, Debug, PartialEq)]
pub enum Array {
    /// Array given to the stage or computed in it.
    Local(String),
    /// Prepared coefficient.
    Coefficient(String, Extent),
    /// Table of constants.
    Table(String, Extent),
    /// One number, repeated.
    Filled(Box<Expression>, usize),
}

impl Array {
    /// Refers to an array of the stage by its name.
    pub fn local(name: impl Into<String>) -> Self {
        Self::Local(name.into())
    }
}

/// Expression of one number or condition.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// Number.
    Number(f64),
    /// Named number of the stage.
    Name(String),
    /// Flag of the stage.
    Flag(String),
    /// Element of an array.
    Element(Array, Vec<Index>),
    /// Field of a structure.
    Field(ArgumentStruct, String),
    /// Coefficient that SIMD lanes share.
    Shared(Box<Self>),
    /// Binary operation.
    Binary(Operator, Box<Self>, Box<Self>),
    /// -a
    Negate(Box<Self>),
    /// Call of a function of the emitted file.
    Call(&'static str, Vec<Self>),
    /// `[a, b, then, otherwise]`: `then` if a > b, else `otherwise`.
    Select(Box<[Self; 4]>),
    /// Operation on the bits of a number, used by the elementary functions.
    Primitive(&'static str, Vec<Self>),
    /// True if the guard with this index is positive in the regime of the stage.
    Positive(usize),
    /// True if a > b in all lanes.
    Greater(Box<[Self; 2]>),
    /// True if both conditions are true.
    And(Box<[Self; 2]>),
    /// Constant true.
    True,
}

impl Expression {
    /// Refers to a named number of the stage.
    pub fn name(name: impl Into<String>) -> Self {
        Self::Name(name.into())
    }

    /// Refers to an element of an array of the stage.
    pub fn element(array: impl Into<String>, indices: impl Into<Vec<Index>>) -> Self {
        Self::Element(Array::local(array), indices.into())
    }

    fn binary(operator: Operator, a: &Self, b: &Self) -> Self {
        Self::Binary(operator, Box::new(a.clone()), Box::new(b.clone()))
    }

    /// a + b
    pub fn add(a: &Self, b: &Self) -> Self {
        Self::binary(Operator::Add, a, b)
    }

    /// a - b
    pub fn subtract(a: &Self, b: &Self) -> Self {
        Self::binary(Operator::Subtract, a, b)
    }

    /// a b
    pub fn multiply(a: &Self, b: &Self) -> Self {
        Self::binary(Operator::Multiply, a, b)
    }

    /// a / b
    pub fn divide(a: &Self, b: &Self) -> Self {
        Self::binary(Operator::Divide, a, b)
    }

    /// `a && b`
    pub fn and(a: Self, b: Self) -> Self {
        Self::And(Box::new([a, b]))
    }

    /// a > b
    pub fn greater(a: Self, b: Self) -> Self {
        Self::Greater(Box::new([a, b]))
    }

    /// -a
    pub fn negate(a: &Self) -> Self {
        Self::Negate(Box::new(a.clone()))
    }

    /// Returns the number of operations.
    pub fn size(&self) -> usize {
        let of = |parts: &[Self]| 1 + parts.iter().map(Self::size).sum::<usize>();
        match self {
            Self::Number(_)
            | Self::Name(_)
            | Self::Flag(_)
            | Self::Element(..)
            | Self::Field(..)
            | Self::True => 0,
            Self::Binary(_, a, b) => 1 + a.size() + b.size(),
            Self::Negate(a) | Self::Shared(a) => 1 + a.size(),
            Self::Call(_, arguments) | Self::Primitive(_, arguments) => of(arguments),
            Self::Select(parts) => of(&**parts),
            Self::Greater(parts) | Self::And(parts) => of(&**parts),
            Self::Positive(_) => 1,
        }
    }
}
