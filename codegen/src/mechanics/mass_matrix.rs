//! The mass matrix by its blocks: coordinates, modes, and the coupling between them.

use crate::symbolic::graph::{Graph, Id};
use crate::symbolic::matrix::StructuredMatrix;

/// The mass matrix by blocks.
#[derive(Clone, Debug)]
pub struct MassMatrix {
    /// coordinates x coordinates
    pub scalars: Vec<Vec<Id>>,
    /// For each coordinate and field the vector over the modes.
    pub coupling: Vec<Vec<Id>>,
    /// For each pair of fields the block over their modes.
    pub modal: Vec<Vec<StructuredMatrix>>,
}

impl MassMatrix {
    pub(crate) fn assembled_blocks(&self, graph: &mut Graph) -> Vec<(usize, Id, usize)> {
        let mut blocks = Vec::new();
        for (row, columns) in self.modal.iter().enumerate() {
            for (column, block) in columns.iter().enumerate().skip(row) {
                if !block.is_zero() {
                    blocks.push((row, block.assemble(graph), column));
                }
            }
        }
        blocks
    }
}
