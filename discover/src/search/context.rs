//! Context of a round of the search.

use crate::catalogue::effect::Effect;
use crate::fit::fitted::Fit;
use crate::model::problem::EstimationProblem;
use crate::thresholds;

/// Context of a round of the search.
#[derive(Clone, Copy)]
pub struct Context<'r> {
    /// Problem of the dataset.
    pub problem: &'r EstimationProblem<'r>,
    /// Fit to be improved.
    pub fit: &'r Fit,
    /// Noise floor, in standard deviations.
    pub floor: f64,
    /// Catalogue.
    pub effects: &'r [Effect],
    /// Receiver of progress lines.
    pub progress: &'r (dyn Fn(&str) + Sync),
}

impl Context<'_> {
    /// Returns true if the residual is close to the noise.
    pub fn is_near(&self) -> bool {
        self.fit.train.rms < thresholds::MUCH_IS_LEFT
    }

    /// Returns true if candidates are first screened over whole windows.
    pub fn is_whole(&self) -> bool {
        self.is_near() || !self.problem.estimates_initial_states()
    }

    /// Returns true if a fit explains most of the gap to the noise floor.
    pub fn explains_most(&self, fit: &Fit) -> bool {
        let little = (thresholds::CLOSE * self.floor).max(thresholds::MOST_OF * self.fit.rms());
        fit.leaves_less(little)
    }
}
