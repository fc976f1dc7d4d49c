//! The values an operation reads, which stand before its own.

use super::places::Places;
use crate::program::{Extent, Program, ValueId};

/// Read access to operands while a value is computed: operands stand before it.
pub(super) struct Operands<'a> {
    pub(super) memory: &'a [f64],
    pub(super) places: &'a Places,
    pub(super) program: &'a Program,
}

impl<'a> Operands<'a> {
    pub(super) fn slice(&self, id: ValueId) -> &'a [f64] {
        let start = self.places.offset(id);
        &self.memory[start..start + self.program.values[id.0].extent.length()]
    }

    /// The operand's numbers and the distance from one element to the next: 0 for a
    /// scalar, which stands for every element.
    pub(super) fn strided(&self, id: ValueId) -> (&'a [f64], usize) {
        let scalar = self.program.values[id.0].extent == Extent::Scalar;
        (self.slice(id), usize::from(!scalar))
    }

    pub(super) fn matrix(&self, id: ValueId) -> (&'a [f64], usize, usize) {
        match self.program.values[id.0].extent {
            Extent::Matrix(rows, columns) => (self.slice(id), rows, columns),
            other => (self.slice(id), other.length(), 1),
        }
    }
}
