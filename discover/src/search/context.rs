//! Context of a round of the search.

use crate::catalogue::effect::Effect;
use crate::fit::fit_result::Fit;
use crate::model::problem::EstimationProblem;
use crate::thresholds;

/// Problem, fit and settings of a round of the search.
#[derive(Clone, Copy)]
pub struct RoundContext<'r> {
    /// Problem of the dataset.
    pub problem: &'r EstimationProblem<'r>,
    /// Fit to be improved.
    pub fit: &'r Fit,
    /// Noise floor, in standard deviations.
    pub floor: f64,
    /// Effects of the catalogue and of the user.
    pub effects: &'r [Effect],
    /// Receiver of progress lines.
    pub progress: &'r (dyn Fn(&str) + Sync),
}

impl RoundContext<'_> {
    /// Returns true if the residual is close to the noise.
    pub fn is_near_floor(&self) -> bool {
        self.fit.train.rms < thresholds::MIN_RMS_FAR_FROM_NOISE
    }

    /// Returns true if candidates are first screened over whole windows.
    pub fn starts_with_whole_windows(&self) -> bool {
        self.is_near_floor() || !self.problem.estimates_initial_states()
    }

    /// Returns true if a fit explains most of the gap to the noise floor.
    pub fn explains_most_of_gap(&self, fit: &Fit) -> bool {
        let little = (thresholds::MAX_FLOOR_RATIO_TO_STOP * self.floor)
            .max(thresholds::MAX_REMAINING_FRACTION * self.fit.rms());
        fit.is_below(little)
    }
}
