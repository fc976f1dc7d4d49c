//! Maximum and RMS of quantities over a motion.
//!
//! Both are computed from the steps of the solver and from the states inside them, not from a grid of times. Each step
//! is divided into panels until polynomials represent the quantity. Every event ends a step, so its values on both
//! sides are used.

mod meter;
mod meters;
mod polynomial;
mod state_bounds;
mod step_quantities;

pub(crate) use meters::Meters;
pub(crate) use step_quantities::Observables;

/// Quantity of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// State, by its index.
    State(usize),
    /// Observable, by its index.
    Observable(usize),
}

/// Statistic of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Statistic {
    /// Greatest value.
    Maximum,
    /// Root of the mean square over time.
    RootMeanSquare,
}

/// Measurement of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Measured quantity.
    pub quantity: Quantity,
    /// Statistic of the quantity.
    pub statistic: Statistic,
    /// Time at which the measurement starts, s.
    pub begin: f64,
    /// Typical size of the quantity, SI; see [`CompiledModel::typical_size`](crate::CompiledModel::typical_size).
    pub typical_size: f64,
}
