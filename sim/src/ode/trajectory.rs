//! What a simulation leaves.

/// A switching surface crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Switch {
    /// When, s.
    pub t: f64,
    /// The index of the switching function.
    pub guard: usize,
    /// Whether the function is positive from here on.
    pub to_positive: bool,
}

/// What was done to get there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Steps that advanced the solution.
    pub steps: u64,
    /// Steps refused by the error estimate.
    pub rejected: u64,
    /// Trial steps for samples and for the approach to switching surfaces.
    pub trials: u64,
    /// Evaluations of the right-hand side.
    pub evaluations: u64,
}

/// States at the times asked for, the switches between them and the work.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// The times of the samples, s.
    pub times: Vec<f64>,
    /// The state at each of these times.
    pub states: Vec<Vec<f64>>,
    /// The state at the end of the simulated span.
    pub last: Vec<f64>,
    /// The switching surfaces crossed, in order.
    pub switches: Vec<Switch>,
    /// What was done.
    pub work: Work,
}
