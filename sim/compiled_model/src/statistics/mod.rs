//! Maximum and RMS of quantities over a motion.
//!
//! Both follow from the steps of the solver and from the states inside them, not from a grid of times. Each step is
//! divided into panels until polynomials represent the quantity. The values on both sides of every event are ends of steps.

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
    /// State of this index.
    State(usize),
    /// Observable of this index.
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
    /// Its statistic.
    pub statistic: Statistic,
    /// Time from which on it is measured, s.
    pub begin: f64,
    /// Typical size of the quantity, SI; see [`CompiledModel::typical_size`](crate::CompiledModel::typical_size).
    pub typical_size: f64,
}
