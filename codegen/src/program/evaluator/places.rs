use crate::program::{Extent, Program, ValueId};

/// Offsets of the values of a program in one block of memory.
#[derive(Clone, Debug)]
pub struct Places {
    offsets: Vec<usize>,
    size: usize,
}

impl Places {
    /// Arranges the values one after the other. Vectors and matrices begin at an even offset, so that a pair
    /// of elements never crosses a cache line.
    pub fn new(program: &Program) -> Self {
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

    /// Returns the offset of a value's first number.
    pub fn offset(&self, id: ValueId) -> usize {
        self.offsets[id.index()]
    }

    /// Returns the total count of numbers.
    pub fn size(&self) -> usize {
        self.size
    }
}
