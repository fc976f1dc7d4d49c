//! Priors of the initial states of windows.

use crate::ids::WindowId;
use crate::thresholds;
use nalgebra::{DMatrix, DVector};

/// Source of the mean of a prior.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PriorSource {
    /// Known initial state of the record, from the dataset file.
    Dataset,
    /// Final state of the preceding window.
    PrecedingWindow,
    /// First samples of a record. For states that they do not show, the standard deviation is about
    /// the range of the state.
    FirstSamples,
}

/// Prior of the initial state of each window: mean and standard deviation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InitialStatePrior {
    /// Mean for each window.
    pub mean: Vec<Vec<f64>>,
    /// Standard deviation of each state, if the mean is from the dataset or the preceding window.
    pub sd: Vec<f64>,
    /// Source of each mean. If empty, all means are final states of preceding windows.
    pub sources: Vec<PriorSource>,
    /// Rows that transform measured initial states to unit covariance, if the covariance of the
    /// states is known.
    pub whitening: Option<DMatrix<f64>>,
}

impl InitialStatePrior {
    /// Returns the cost of an initial state of a window.
    pub fn compute_cost(&self, window: WindowId, start: &[f64]) -> f64 {
        let Some(mean) = self.mean.get(window.index()) else {
            return 0.0;
        };
        let deviation = start.iter().zip(mean).map(|(x, m)| x - m);
        let deviation = DVector::from_iterator(start.len().min(mean.len()), deviation);
        (self.deviation_rows(window) * deviation).norm_squared()
    }

    /// Returns the rows that transform the deviation from the mean to standard deviations.
    pub fn deviation_rows(&self, window: WindowId) -> DMatrix<f64> {
        let source = self.sources.get(window.index());
        match (&self.whitening, source) {
            (Some(rows), Some(PriorSource::FirstSamples)) => rows.clone(),
            _ => create_reciprocal_matrix(self.window_sd(window)),
        }
    }

    /// Returns the rows that damp a step of an initial state.
    pub fn damping_rows(&self) -> DMatrix<f64> {
        match &self.whitening {
            Some(rows) => rows / thresholds::INITIAL_STATE_PRIOR_IN_RANGES,
            None => create_reciprocal_matrix(self.sd.iter().copied()),
        }
    }

    /// Returns the prior without means from preceding windows. These means are valid for the
    /// present unknowns only and would add information that the records do not contain. The
    /// standard deviation of the first state of a record is about its range, and its mean is the
    /// estimated initial state. With a mean of 0 for states that the first samples do not show, the
    /// prior could be far from any motion.
    pub fn without_preceding(&self, initial_states: &[Vec<f64>]) -> Self {
        let mut prior = self.clone();
        let all = prior.sources.iter_mut().zip(&mut prior.mean);
        for ((source, mean), state) in all.zip(initial_states) {
            match source {
                PriorSource::Dataset => {}
                PriorSource::PrecedingWindow => *source = PriorSource::FirstSamples,
                PriorSource::FirstSamples => mean.clone_from(state),
            }
        }
        prior
    }

    /// Returns the standard deviation of each state of a window.
    pub fn window_sd(&self, window: WindowId) -> impl Iterator<Item = f64> {
        let source = self.sources.get(window.index());
        let times = match source.unwrap_or(&PriorSource::PrecedingWindow) {
            PriorSource::Dataset | PriorSource::PrecedingWindow => 1.0,
            PriorSource::FirstSamples => 1.0 / thresholds::INITIAL_STATE_PRIOR_IN_RANGES,
        };
        self.sd.iter().map(move |sd| times * sd)
    }
}

/// Returns the diagonal matrix of reciprocal standard deviations.
fn create_reciprocal_matrix(sds: impl Iterator<Item = f64>) -> DMatrix<f64> {
    let weights: Vec<f64> = sds.map(|sd| 1.0 / sd).collect();
    DMatrix::from_diagonal(&DVector::from_vec(weights))
}

/// Initial states of windows and their prior.
#[derive(Clone, Debug, Default)]
pub struct InitialStates {
    /// Prior of the states.
    pub prior: InitialStatePrior,
    /// State of each window.
    pub states: Vec<Vec<f64>>,
}
