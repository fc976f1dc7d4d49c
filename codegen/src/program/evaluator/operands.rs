//! Operands of an operation.

use super::places::Places;
use crate::program::{Extent, Program, ValueId};

/// Read access to the operands of a value; in memory, they precede the value.
pub(super) struct Operands<'a, N> {
    pub(super) memory: &'a [N],
    pub(super) places: &'a Places,
    pub(super) program: &'a Program,
}

impl<'a, N> Operands<'a, N> {
    pub(super) fn slice(&self, id: ValueId) -> &'a [N] {
        let start = self.places.offset(id);
        &self.memory[start..start + self.program.values[id.0].extent.length()]
    }

    /// Returns the elements of an operand and their stride; the stride of a scalar is 0, which repeats it.
    pub(super) fn strided(&self, id: ValueId) -> (&'a [N], usize) {
        let scalar = self.program.values[id.0].extent == Extent::Scalar;
        (self.slice(id), usize::from(!scalar))
    }

    pub(super) fn matrix(&self, id: ValueId) -> (&'a [N], usize, usize) {
        match self.program.values[id.0].extent {
            Extent::Matrix(rows, columns) => (self.slice(id), rows, columns),
            other => (self.slice(id), other.length(), 1),
        }
    }
}
