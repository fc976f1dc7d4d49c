//! Switching surface: a node and the function that switches at its zero.

use eomgen_model_spec::model::Function;

use crate::symbolic::graph::NodeId;

/// Switching surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guard {
    /// Function that changes sign at the surface.
    pub value: NodeId,
    /// Function that switches.
    pub function: Function,
}
