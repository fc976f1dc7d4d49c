//! Rows of equations as nodes of the graph.

use crate::symbolic::graph::NodeId;

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
}
