//! The mass matrix by its blocks: coordinates, modes, and the coupling between them.

use crate::symbolic::graph::{Graph, NodeId};
use crate::symbolic::matrix::StructuredMatrix;
use eomgen_model_spec::ids::FieldId;

/// The mass matrix by blocks.
#[derive(Clone, Debug)]
pub struct MassMatrix {
    /// coordinates x coordinates
    pub scalars: Vec<Vec<NodeId>>,
    /// For each coordinate and field the vector over the modes.
    pub coupling: Vec<Vec<NodeId>>,
    /// For each pair of fields the block over their modes.
    pub modal: Vec<Vec<StructuredMatrix>>,
}

/// A block of the mass matrix over the modes of two fields, as one node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModalMassBlock {
    /// The field of the rows.
    pub rows: FieldId,
    /// The field of the columns.
    pub columns: FieldId,
    /// Modes of the one times modes of the other.
    pub matrix: NodeId,
}

impl MassMatrix {
    /// The blocks over modes on and above the diagonal that are not 0.
    pub(crate) fn assembled_blocks(&self, graph: &mut Graph) -> Vec<ModalMassBlock> {
        let mut blocks = Vec::new();
        let fields = FieldId::first(self.modal.len());
        for (row, columns) in fields.clone().zip(&self.modal) {
            for (column, block) in fields.clone().zip(columns).skip(row.index()) {
                if !block.is_zero() {
                    blocks.push(ModalMassBlock {
                        rows: row,
                        columns: column,
                        matrix: block.assemble(graph),
                    });
                }
            }
        }
        blocks
    }
}
