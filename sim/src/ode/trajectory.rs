//! Results of a simulation.

use super::events::{Event, Jump};

/// Solver statistics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SolverStatistics {
    /// Number of accepted steps.
    pub steps: u64,
    /// Number of steps that the error estimate rejected.
    pub rejected_steps: u64,
    /// Number of trial steps for samples and for approaches to switching surfaces.
    pub trial_steps: u64,
    /// Number of evaluations of the right-hand side.
    pub evaluations: u64,
}

/// States at the samples, events and solver statistics.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Times of the samples, s.
    pub times: Vec<f64>,
    /// State at each sample.
    pub states: Vec<Vec<f64>>,
    /// State at the end of the simulated time.
    pub final_state: Vec<f64>,
    /// Events, in order of time.
    pub events: Vec<Event>,
    /// Jumps of the state, in order of time. They are caused by events at the same time; without such events,
    /// by a jump of the inputs.
    pub jumps: Vec<Jump>,
    /// Solver statistics.
    pub statistics: SolverStatistics,
}
