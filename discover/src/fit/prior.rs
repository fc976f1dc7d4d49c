//! What is known of the windows' initial states before their samples are looked at.

use crate::ids::WindowId;
use crate::thresholds;
use nalgebra::{DMatrix, DVector};

/// Where that comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// From the dataset: where the machine was at the beginning of the record.
    Stated,
    /// From the window before, whose motion ends there.
    Carried,
    /// From the first samples of a record, as far as these show it: it is known to about the range of
    /// each state.
    Measured,
}

/// What is known before of each window's initial state: mean and standard deviation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InitialStatePrior {
    /// One state per window.
    pub mean: Vec<Vec<f64>>,
    /// One standard deviation per state, where the mean is stated or carried.
    pub sd: Vec<f64>,
    /// Where each mean comes from; all are carried where nothing stands here.
    pub sources: Vec<Source>,
    /// Rows that bring measured initial states to unit variance, if the covariance of the states is known.
    pub whitening: Option<DMatrix<f64>>,
}

impl InitialStatePrior {
    /// What it adds to the cost of a window that begins so.
    pub fn cost(&self, window: WindowId, start: &[f64]) -> f64 {
        let Some(mean) = self.mean.get(window.index()) else {
            return 0.0;
        };
        let deviation = start.iter().zip(mean).map(|(x, m)| x - m);
        let deviation = DVector::from_iterator(start.len().min(mean.len()), deviation);
        (self.rows(window) * deviation).norm_squared()
    }

    /// Rows of the least-squares problem of a window's initial state: a deviation from the mean times these
    /// is in standard deviations.
    pub fn rows(&self, window: WindowId) -> DMatrix<f64> {
        let source = self.sources.get(window.index());
        match (&self.whitening, source) {
            (Some(rows), Some(Source::Measured)) => rows.clone(),
            _ => reciprocals(self.sd_in(window)),
        }
    }

    /// Rows that damp a step of an initial state.
    pub fn damping_rows(&self) -> DMatrix<f64> {
        match &self.whitening {
            Some(rows) => rows / thresholds::INITIAL_STATE_PRIOR,
            None => reciprocals(self.sd.iter().copied()),
        }
    }

    /// The same with nothing carried from window to window: what a motion at these unknowns carries does
    /// not hold at others, and would say more of them than records do.
    pub fn without_carried(&self) -> Self {
        let unknown = |source: &Source| match source {
            Source::Stated => Source::Stated,
            Source::Carried | Source::Measured => Source::Measured,
        };
        Self {
            sources: self.sources.iter().map(unknown).collect(),
            ..self.clone()
        }
    }

    /// One standard deviation of each state of a window.
    pub fn sd_in(&self, window: WindowId) -> impl Iterator<Item = f64> {
        let source = self.sources.get(window.index());
        let times = match source.unwrap_or(&Source::Carried) {
            Source::Stated | Source::Carried => 1.0,
            Source::Measured => 1.0 / thresholds::INITIAL_STATE_PRIOR,
        };
        self.sd.iter().map(move |sd| times * sd)
    }
}

/// The diagonal matrix of the reciprocals of standard deviations.
fn reciprocals(sds: impl Iterator<Item = f64>) -> DMatrix<f64> {
    let weights: Vec<f64> = sds.map(|sd| 1.0 / sd).collect();
    DMatrix::from_diagonal(&DVector::from_vec(weights))
}

/// Initial states of windows, and what was known of them before.
#[derive(Clone, Debug, Default)]
pub struct InitialStates {
    /// What was known.
    pub prior: InitialStatePrior,
    /// One state per window.
    pub states: Vec<Vec<f64>>,
}
