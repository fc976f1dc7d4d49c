//! A switching surface, as a node and the function that switches there.

use eomgen_model_spec::model::Function;

use crate::symbolic::graph::NodeId;

/// A switching surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guard {
    /// Changes sign where the model switches.
    pub value: NodeId,
    /// The function that switches.
    pub function: Function,
}
