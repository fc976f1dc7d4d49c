//! Reference motion, linearised model and segments for the evaluation of laws and curves.

use crate::fit::fit_result::Fit;
use crate::free_function::drives::{DrivenModel, average_drive, is_visible};
use crate::free_function::nuisances::respond_to_unknowns;
use crate::free_function::reference_motion::ReferenceMotion;
use crate::free_function::segments::Segments;
use crate::model::problem::EstimationProblem;
use crate::thresholds;

/// Records and model of a fit, linearised along the reference motion.
pub(crate) struct Scene<'s> {
    /// Problem of the dataset.
    pub problem: &'s EstimationProblem<'s>,
    /// Fit whose residual is to be explained.
    pub fit: &'s Fit,
    /// Reference motion of the records.
    pub motion: ReferenceMotion,
    /// Accelerations of the model along the reference motion.
    pub base: DrivenModel,
    /// Segments with free initial states.
    pub segments: Segments,
}

impl<'s> Scene<'s> {
    /// Follows the records and linearises the model; `None` if the records cannot be followed.
    pub fn follow_records(problem: &'s EstimationProblem<'s>, fit: &'s Fit) -> Option<Self> {
        let motion = ReferenceMotion::follow_records(problem, fit)?;
        let base =
            DrivenModel::new(&fit.model, &motion.values).with_reference_motion(&motion, &fit.model);
        let nuisances = respond_to_unknowns(&motion, problem, fit, &base);
        let length = motion
            .records
            .iter()
            .map(|record| record.times[record.times.len() - 1] - record.times[0])
            .fold(0.0, f64::max);
        let window = problem.dataset.window.unwrap_or(length);
        let length = window * thresholds::SEGMENT_FRACTION;
        let segments = Segments::split_motion(&motion, fit, &nuisances, length);
        Some(Self {
            problem,
            fit,
            motion,
            base,
            segments,
        })
    }

    /// Returns the RMS residual in segments with the accelerations of another fit, over training
    /// and test records, in standard deviations. `None` if the other fit has additional coordinates
    /// or equal accelerations.
    pub fn evaluate_fit(&self, fit: &Fit) -> Option<f64> {
        let shooting = fit.training_shooting(self.problem);
        let values = shooting.parameter_values(&fit.train.estimate.theta);
        let mut moved = DrivenModel::with_added_states(&self.fit.model, &fit.model, &values)?;
        let drive = average_drive(&self.motion, &self.base, &mut moved, 1.0);
        let left = || self.segments.fit_drives(&self.motion, &[], Some(&drive));
        is_visible(&drive).then(|| left().rms())
    }
}
