//! Refinement of the quadrature of the power.

use eomgen_sim::ode::Interior;

/// Refinement of a quadrature over a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Refinement {
    /// Origin of the states inside the step.
    pub interior: Interior,
    /// Maximum number of panels.
    pub most_panels: usize,
    /// True if panels whose energy changes without work are halved too. A transient that is shorter than the distances
    /// of the nodes is found only thus.
    pub balances_panels: bool,
}
