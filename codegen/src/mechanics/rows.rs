//! Rows of equations as nodes of the graph.

use eomgen_model_spec::ids::FieldId;

use crate::symbolic::graph::{Graph, NodeId, Space};

/// Vector over all degrees of freedom.
#[derive(Clone, Debug)]
pub struct RowNodes {
    /// Scalars, one for each coordinate.
    pub scalars: Vec<NodeId>,
    /// Vectors over the modes, one for each field.
    pub modal: Vec<NodeId>,
}

impl RowNodes {
    /// Returns all nodes, coordinates first.
    pub fn nodes(&self) -> Vec<NodeId> {
        self.scalars.iter().chain(&self.modal).copied().collect()
    }

    /// Returns the scalar product with another vector.
    pub(crate) fn dot(&self, graph: &mut Graph, other: &Self) -> NodeId {
        let mut terms = Vec::new();
        for (a, b) in self.scalars.iter().zip(&other.scalars) {
            terms.push((1.0, graph.multiply(*a, *b)));
        }
        let fields = FieldId::first(self.modal.len());
        for (field, (a, b)) in fields.zip(self.modal.iter().zip(&other.modal)) {
            let product = graph.multiply(*a, *b);
            terms.push((1.0, graph.sum_over_space(Space::Modes(field), product)));
        }
        graph.combine(&terms)
    }
}
