//! Elements that an instruction processes: one element or two adjacent elements, in registers or in memory.

use cranelift_codegen::ir::{Type, Value, types};

/// Largest length of an unrolled vector in registers. A vector of this length needs four of the sixteen registers.
pub const MAX_REGISTER_VECTOR: usize = 8;

/// Number of adjacent elements in one register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lanes {
    One,
    Two,
}

/// Reference to one element, or to two adjacent elements.
#[derive(Clone, Copy, Debug)]
pub struct ElementRef {
    /// Byte offset that a loop adds to the address.
    pub moving: Option<Value>,
    /// Index of the element in the first iteration of the loop.
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

/// Returns the elements `from..to` in pairs. If their number is odd, the last element is single.
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
    /// Returns the Cranelift type of the content of a register.
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
    /// Base address of the memory.
    pub base: Value,
    /// Index of the first number, relative to the base address.
    pub start: usize,
    /// True if this function does not write the numbers.
    pub constant: bool,
}
