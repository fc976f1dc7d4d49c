//! Adaptive quadrature of the power: settings.

use eomgen_sim::ode::Interior;

/// Settings of an adaptive quadrature over a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Refinement {
    /// Source of the states inside the step.
    pub interior: Interior,
    /// Maximum number of panels.
    pub most_panels: usize,
    /// True if panels whose energy changes without work are halved too. Only this finds a transient that is shorter
    /// than the distance between nodes.
    pub balances_panels: bool,
}
