//! Entries of the mass matrix as nodes of the graph.

use crate::symbolic::graph::{Graph, NodeId};
use crate::symbolic::matrix::StructuredMatrix;
use eomgen_model_spec::ids::FieldId;

/// Mass matrix by blocks.
#[derive(Clone, Debug)]
pub struct MassMatrix {
    /// Block of the coordinates.
    pub scalars: Vec<Vec<NodeId>>,
    /// Coupling of each coordinate (outer index) with each field (inner index), as vectors over the modes.
    pub coupling: Vec<Vec<NodeId>>,
    /// Block over the modes for each pair of fields.
    pub modal: Vec<Vec<StructuredMatrix>>,
}

/// Block of the mass matrix over the modes of two fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModalMassBlock {
    /// Field of the rows.
    pub rows: FieldId,
    /// Field of the columns.
    pub columns: FieldId,
    /// Matrix, modes of the rows' field by modes of the columns' field.
    pub matrix: NodeId,
}

impl MassMatrix {
    /// Returns the nonzero modal blocks on and above the diagonal.
    pub(crate) fn assemble_blocks(&self, graph: &mut Graph) -> Vec<ModalMassBlock> {
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
