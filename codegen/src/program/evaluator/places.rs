use crate::program::{Extent, Program, ValueId};

/// Offsets of the values of a program in one block of memory.
#[derive(Clone, Debug)]
pub struct Places {
    offsets: Vec<usize>,
    size: usize,
}

impl Places {
    /// Assigns consecutive offsets to the values. Vectors and matrices begin at an even offset; therefore no pair of
    /// elements crosses a cache line.
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

    /// Returns the offset of the first element of a value.
    pub fn offset(&self, id: ValueId) -> usize {
        self.offsets[id.index()]
    }

    /// Returns the number of elements of all values, with padding.
    pub fn size(&self) -> usize {
        self.size
    }
}
