//! What a vector over all degrees of freedom is made of: a number per coordinate, a vector per field.

use crate::symbolic::graph::Id;

/// One entry per coordinate, then one vector per field.
#[derive(Clone, Debug)]
pub struct Rows {
    /// Scalars, one per coordinate.
    pub scalars: Vec<Id>,
    /// Vectors over the modes, one per field.
    pub modal: Vec<Id>,
}

impl Rows {
    /// All nodes, coordinates first.
    pub fn nodes(&self) -> Vec<Id> {
        self.scalars.iter().chain(&self.modal).copied().collect()
    }
}
