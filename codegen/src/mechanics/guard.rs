//! Switching surface: its switching function and the piecewise function that switches there.

use eomgen_model_spec::model::Function;

use crate::symbolic::graph::NodeId;

/// Switching surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guard {
    /// Switching function, whose zeros are the surface.
    pub value: NodeId,
    /// Piecewise function that switches at the surface.
    pub function: Function,
}
