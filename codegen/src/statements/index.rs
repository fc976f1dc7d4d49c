//! Array indices: numbers, loop variables, and their sums and products.

/// Index of an array element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Index {
    /// Constant.
    Number(usize),
    /// Variable of a loop.
    Variable(&'static str),
    /// Sum of two indices.
    Sum(Box<Self>, Box<Self>),
    /// Product of two indices.
    Product(Box<Self>, Box<Self>),
}

impl Index {
    /// Returns `first + rest`.
    pub fn from_first(first: usize, rest: impl Into<Self>) -> Self {
        match first {
            0 => rest.into(),
            first => Self::Number(first).offset_by(rest),
        }
    }

    /// Returns `self + other`.
    pub fn offset_by(self, other: impl Into<Self>) -> Self {
        Self::Sum(Box::new(self), Box::new(other.into()))
    }

    /// Returns `count * other`.
    pub fn from_multiple(count: usize, other: impl Into<Self>) -> Self {
        Self::Product(Box::new(Self::Number(count)), Box::new(other.into()))
    }
}

impl From<usize> for Index {
    fn from(number: usize) -> Self {
        Self::Number(number)
    }
}

impl From<&'static str> for Index {
    fn from(variable: &'static str) -> Self {
        Self::Variable(variable)
    }
}
