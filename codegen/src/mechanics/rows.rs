//! What a vector over all degrees of freedom is made of: a number per coordinate, a vector per field.

use crate::symbolic::graph::NodeId;

/// One entry per coordinate, then one vector per field.
#[derive(Clone, Debug)]
pub struct RowNodes {
    /// Scalars, one per coordinate.
    pub scalars: Vec<NodeId>,
    /// Vectors over the modes, one per field.
    pub modal: Vec<NodeId>,
}

impl RowNodes {
    /// All nodes, coordinates first.
    pub fn nodes(&self) -> Vec<NodeId> {
        self.scalars.iter().chain(&self.modal).copied().collect()
    }
}
