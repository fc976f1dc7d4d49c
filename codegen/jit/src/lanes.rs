//! Which elements an instruction is about: one or two neighbours, in registers or in memory.

use cranelift_codegen::ir::{Type, Value, types};

/// Vectors up to this length are written out and live in registers: four of the sixteen
/// that there are.
pub const SHORT: usize = 8;

/// How many neighbouring elements one register holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lanes {
    /// One.
    One,
    /// Two.
    Two,
}

/// Which element, or two neighbouring ones.
#[derive(Clone, Copy, Debug)]
pub struct At {
    /// Bytes that a loop adds.
    pub moving: Option<Value>,
    /// The element where the loop stands at 0.
    pub element: usize,
    /// How many.
    pub lanes: Lanes,
}

impl At {
    /// Element number `element`.
    pub fn one(element: usize) -> Self {
        Self {
            moving: None,
            element,
            lanes: Lanes::One,
        }
    }

    /// Elements number `element` and the next.
    pub fn two(moving: Option<Value>, element: usize) -> Self {
        Self {
            moving,
            element,
            lanes: Lanes::Two,
        }
    }
}

/// The elements `from..to` in pairs, a single one last.
pub fn pairs(from: usize, to: usize) -> impl Iterator<Item = At> {
    (from..to).step_by(2).map(move |element| {
        if element + 1 < to {
            At::two(None, element)
        } else {
            At::one(element)
        }
    })
}

impl Lanes {
    /// The type of a register's content.
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
    /// Where they are counted from.
    pub base: Value,
    /// Which number from there is the first.
    pub start: usize,
    /// Whether nothing in this function writes them.
    pub constant: bool,
}
