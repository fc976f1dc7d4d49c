//! What a round of the search is about.

use crate::catalogue::effect::Effect;
use crate::fit::fitted::Fit;
use crate::model::problem::EstimationProblem;
use crate::thresholds;

/// What a round of the search is about.
#[derive(Clone, Copy)]
pub struct Context<'r> {
    /// The dataset.
    pub problem: &'r EstimationProblem<'r>,
    /// The fit to be bettered.
    pub fit: &'r Fit,
    /// What a right model would leave, in standard deviations.
    pub floor: f64,
    /// The catalogue.
    pub effects: &'r [Effect],
    /// Is told what is done.
    pub progress: &'r (dyn Fn(&str) + Sync),
}

impl Context<'_> {
    /// Whether little more than noise is left.
    pub fn is_near(&self) -> bool {
        self.fit.train.rms < thresholds::MUCH_IS_LEFT
    }

    /// Whether candidates are screened over whole windows first.
    pub fn is_whole(&self) -> bool {
        self.is_near() || !self.problem.estimates_initial_states()
    }

    /// Whether what it explains is most of the way to what a right model would leave.
    pub fn explains_most(&self, fit: &Fit) -> bool {
        let little = (thresholds::CLOSE * self.floor).max(thresholds::MOST_OF * self.fit.rms());
        fit.leaves_less(little)
    }
}
