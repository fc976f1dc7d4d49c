//! Array indices: numbers, loop variables, and sums and products of these.

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
        Self::Number(count).times(other)
    }

    /// Returns `self * other`.
    pub fn times(self, other: impl Into<Self>) -> Self {
        Self::Product(Box::new(self), Box::new(other.into()))
    }
}

/// Half-open range of the indices of a loop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Span {
    /// First index.
    pub from: Index,
    /// Index after the last one.
    pub to: Index,
    /// True if the loop runs from the last index down to the first.
    pub reversed: bool,
}

impl Span {
    /// Returns the range `from..to`, in ascending order.
    pub fn between(from: impl Into<Index>, to: impl Into<Index>) -> Self {
        Self {
            from: from.into(),
            to: to.into(),
            reversed: false,
        }
    }

    /// Returns true if the range is known to be empty.
    pub fn is_empty(&self) -> bool {
        self.numbers().is_some_and(|(from, to)| from >= to)
    }

    /// Returns the bounds if both are numbers.
    pub fn numbers(&self) -> Option<(usize, usize)> {
        match (&self.from, &self.to) {
            (Index::Number(from), Index::Number(to)) => Some((*from, *to)),
            _ => None,
        }
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
