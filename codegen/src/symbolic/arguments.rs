//! Arguments of a function of the expression language: one or two.

use std::ops::Deref;

/// Arguments of a function in the order of the call; they dereference to a slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Arguments<T> {
    /// One argument.
    One([T; 1]),
    /// Two arguments.
    Two([T; 2]),
}

impl<T> Arguments<T> {
    /// Builds arguments from one or two operands; `None` for any other number of operands.
    pub fn from_operands(operands: Vec<T>) -> Option<Self> {
        let operands = match <[T; 1]>::try_from(operands) {
            Ok(one) => return Some(Self::One(one)),
            Err(operands) => operands,
        };
        <[T; 2]>::try_from(operands).ok().map(Self::Two)
    }

    /// Applies `change` to each argument.
    pub fn map<U>(self, change: impl FnMut(T) -> U) -> Arguments<U> {
        match self {
            Self::One(one) => Arguments::One(one.map(change)),
            Self::Two(two) => Arguments::Two(two.map(change)),
        }
    }
}

impl<T> Deref for Arguments<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match self {
            Self::One(one) => one,
            Self::Two(two) => two,
        }
    }
}

impl<T: Copy> From<&[T; 1]> for Arguments<T> {
    fn from(one: &[T; 1]) -> Self {
        Self::One(*one)
    }
}

impl<T: Copy> From<&[T; 2]> for Arguments<T> {
    fn from(two: &[T; 2]) -> Self {
        Self::Two(*two)
    }
}
