//! Places in arrays: numbers, variables of loops, and sums and products of these.

/// One index of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Index {
    /// A number.
    Number(usize),
    /// The variable of a loop.
    Variable(&'static str),
    /// The sum of two.
    Sum(Box<Self>, Box<Self>),
    /// The product of two.
    Product(Box<Self>, Box<Self>),
}

impl Index {
    /// This many places after another.
    pub fn after(first: usize, rest: impl Into<Self>) -> Self {
        Self::Number(first).plus(rest)
    }

    /// The sum of this and another.
    pub fn plus(self, other: impl Into<Self>) -> Self {
        Self::Sum(Box::new(self), Box::new(other.into()))
    }

    /// This many times another.
    pub fn times(count: usize, other: impl Into<Self>) -> Self {
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
