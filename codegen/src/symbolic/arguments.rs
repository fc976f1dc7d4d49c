//! What a function of the expression language is applied to: one operand or two, never
//! another number of them.

use std::ops::Deref;

/// The operands of a function, in the order in which they are written. It reads as a slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Arguments<T> {
    /// Of a function of one argument.
    One([T; 1]),
    /// Of a function of two.
    Two([T; 2]),
}

impl<T> Arguments<T> {
    /// The operands as there are, if there are one or two.
    pub fn of(operands: Vec<T>) -> Option<Self> {
        let operands = match <[T; 1]>::try_from(operands) {
            Ok(one) => return Some(Self::One(one)),
            Err(operands) => operands,
        };
        <[T; 2]>::try_from(operands).ok().map(Self::Two)
    }

    /// The same of what becomes of each operand.
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
