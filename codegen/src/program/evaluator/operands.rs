//! Operands of an operation.

use super::places::Places;
use crate::program::{Extent, Program, ValueId};

/// Read access to the operands of a value, which precede it in memory.
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

    /// Returns the numbers of an operand and the distance between its elements: 0 for a scalar, which is
    /// repeated.
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
