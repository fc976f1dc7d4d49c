//! What is known of the windows' initial states before their samples are looked at.

use crate::ids::WindowId;

/// What is known before of each window's initial state: mean and standard deviation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InitialStatePrior {
    /// One state per window.
    pub mean: Vec<Vec<f64>>,
    /// One standard deviation per state.
    pub sd: Vec<f64>,
}

impl InitialStatePrior {
    /// What it adds to the cost of a window that begins so.
    pub fn cost(&self, window: WindowId, start: &[f64]) -> f64 {
        let Some(mean) = self.mean.get(window.index()) else {
            return 0.0;
        };
        let terms = start.iter().zip(mean).zip(&self.sd);
        terms.map(|((x, m), sd)| ((x - m) / sd).powi(2)).sum()
    }
}

/// Initial states of windows, and what was known of them before.
#[derive(Clone, Debug, Default)]
pub struct InitialStates {
    /// What was known.
    pub prior: InitialStatePrior,
    /// One state per window.
    pub states: Vec<Vec<f64>>,
}
