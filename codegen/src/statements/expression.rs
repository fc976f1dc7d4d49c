//! Expressions of the statements: trees over what was given, prepared or computed before, whose
//! operations each have one IEEE result. A backend prints them.

use super::index::Index;
use crate::program::Extent;

/// An operator between two numbers.
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

/// What a stage is given as named numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Structure {
    /// What was prepared.
    Coefficients,
    /// What is prepared from.
    Parameters,
    /// Signals at the time of the call.
    Inputs,
    /// A direction of the inputs.
    InputDirection,
}

/// Several numbers under one name.
#[derive(Clone, Debug, PartialEq)]
pub enum Array {
    /// Given to the stage or computed in it.
    Local(String),
    /// Prepared.
    Coefficient(String, Extent),
    /// A table of constants.
    Table(String, Extent),
    /// The same number this many times.
    Filled(Box<Expression>, usize),
}

impl Array {
    /// What has this name in the stage.
    pub fn local(name: impl Into<String>) -> Self {
        Self::Local(name.into())
    }
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// A number.
    Number(f64),
    /// What has this name in the stage.
    Name(String),
    /// An element of an array.
    Element(Array, Vec<Index>),
    /// A number of a structure.
    Field(Structure, String),
    /// A coefficient that lanes share.
    Shared(Box<Self>),
    /// An operator between two numbers.
    Binary(Operator, Box<Self>, Box<Self>),
    /// -a
    Negate(Box<Self>),
    /// A function of the emitted file.
    Call(&'static str, Vec<Self>),
    /// `then` where a > b, `otherwise` elsewhere.
    Select(Box<[Self; 4]>),
    /// What acts on the bits of a number: an operation of the elementary functions.
    Primitive(&'static str, Vec<Self>),
    /// Whether a guard, by its place, is positive in the regime of the stage.
    Positive(usize),
    /// Whether a > b, in all lanes.
    Greater(Box<[Self; 2]>),
    /// Whether both hold.
    And(Box<[Self; 2]>),
    /// What holds always.
    True,
}

impl Expression {
    /// What has this name in the stage.
    pub fn name(name: impl Into<String>) -> Self {
        Self::Name(name.into())
    }

    /// Element of what has this name in the stage.
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

    /// How many operations stand in it.
    pub fn size(&self) -> usize {
        let of = |parts: &[Self]| 1 + parts.iter().map(Self::size).sum::<usize>();
        match self {
            Self::Number(_) | Self::Name(_) | Self::Element(..) | Self::Field(..) | Self::True => 0,
            Self::Binary(_, a, b) => 1 + a.size() + b.size(),
            Self::Negate(a) | Self::Shared(a) => 1 + a.size(),
            Self::Call(_, arguments) | Self::Primitive(_, arguments) => of(arguments),
            Self::Select(parts) => of(&**parts),
            Self::Greater(parts) | Self::And(parts) => of(&**parts),
            Self::Positive(_) => 1,
        }
    }
}
