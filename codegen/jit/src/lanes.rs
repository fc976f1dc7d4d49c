//! Elements that an instruction processes: one or two neighbours, in registers or in memory.

use cranelift_codegen::ir::{Type, Value, types};

/// Largest length of an unrolled vector in registers: it uses four of the sixteen registers.
pub const MAX_REGISTER_VECTOR: usize = 8;

/// Number of neighbouring elements in one register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lanes {
    One,
    Two,
}

/// One element, or two neighbouring ones.
#[derive(Clone, Copy, Debug)]
pub struct ElementRef {
    /// Bytes that a loop adds.
    pub moving: Option<Value>,
    /// Element in the first turn of the loop.
    pub element: usize,
    /// Number of elements.
    pub lanes: Lanes,
}

impl ElementRef {
    /// Refers to one element.
    pub fn single(element: usize) -> Self {
        Self {
            moving: None,
            element,
            lanes: Lanes::One,
        }
    }

    /// Refers to an element and the next one.
    pub fn pair(moving: Option<Value>, element: usize) -> Self {
        Self {
            moving,
            element,
            lanes: Lanes::Two,
        }
    }
}

/// Returns the elements `from..to` in pairs, with a single one at the end if the count is odd.
pub fn pairs(from: usize, to: usize) -> impl Iterator<Item = ElementRef> {
    (from..to).step_by(2).map(move |element| {
        if element + 1 < to {
            ElementRef::pair(None, element)
        } else {
            ElementRef::single(element)
        }
    })
}

impl Lanes {
    /// Returns the type of a register's content.
    pub fn kind(self) -> Type {
        match self {
            Self::One => types::F64,
            Self::Two => types::F64X2,
        }
    }
}

/// Numbers in memory.
#[derive(Clone, Copy, Debug)]
pub struct Array {
    /// Base address.
    pub base: Value,
    /// Index of the first number from there.
    pub start: usize,
    /// True if nothing in this function writes them.
    pub constant: bool,
}
