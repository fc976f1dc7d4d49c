//! Where the values of a program stand in one block of memory.

use crate::program::{Extent, Program, ValueId};

/// Where the values of a program stand in one block of memory.
#[derive(Clone, Debug)]
pub struct Places {
    offsets: Vec<usize>,
    size: usize,
}

impl Places {
    /// The places of a program's values, one after the other. Whatever holds several numbers
    /// begins at an even place, so that two of its numbers lie in one line of a cache.
    pub fn of(program: &Program) -> Self {
        let mut offsets = Vec::with_capacity(program.values.len());
        let mut size = 0_usize;
        for value in &program.values {
            if value.extent != Extent::Scalar {
                size = size.next_multiple_of(2);
            }
            offsets.push(size);
            size += value.extent.length();
        }
        Self { offsets, size }
    }

    /// The place of a value's first number.
    pub fn offset(&self, id: ValueId) -> usize {
        self.offsets[id.index()]
    }

    /// How many numbers all values hold.
    pub fn size(&self) -> usize {
        self.size
    }
}
