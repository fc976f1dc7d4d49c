//! A fitted specification: what was estimated, how well it is known, and what it leaves. How it
//! is found is in [`crate::fit::full`].

use crate::fit::prior::InitialStatePrior;
use crate::fit::residuals::Residuals;
use crate::fit::shooting::Shooting;
use crate::ids::UnknownId;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::SpecificationTexts;
use crate::model::unknowns::Unknown;
use crate::thresholds;

/// A fitted specification.
pub struct Fit {
    /// Its texts.
    pub texts: SpecificationTexts,
    /// Its model, ready to run.
    pub model: EstimationModel,
    /// What was estimated.
    pub unknowns: Vec<Unknown>,
    /// One standard deviation of each if the model is right, with correlated residuals allowed for and
    /// no window's initial state known from the window before.
    pub sd: Vec<f64>,
    /// The same by which effects are judged, [`thresholds::WIDER`]: their model may be wrong.
    pub wider_sd: Vec<f64>,
    /// How far off each would be by a misfit of one standard deviation of the noise in every sample
    /// that looks like what the unknown does.
    pub by_alike_misfit: Vec<f64>,
    /// The range of each state.
    pub ranges: Vec<f64>,
    /// What was known of the training windows' initial states.
    pub prior: InitialStatePrior,
    /// How much priors count.
    pub prior_weight: f64,
    /// Its residuals on the training records.
    pub train: Residuals,
    /// Its residuals on the test records.
    pub test: Residuals,
}

impl Fit {
    /// Whether an unknown is held by one of its bounds.
    pub fn is_held(&self, id: UnknownId) -> bool {
        let (value, bounds) = (self.train.estimate.theta[id], self.unknowns[id].bounds);
        value <= bounds.low || value >= bounds.high
    }

    /// The root mean square of its residuals on all records, in standard deviations.
    pub fn rms(&self) -> f64 {
        (0.5 * (self.train.rms.powi(2) + self.test.rms.powi(2))).sqrt()
    }

    /// One standard deviation of an unknown as it is reported, with what a model that leaves more than a
    /// right one, of `floor` standard deviations of the noise, may be off by. What is left is not noise,
    /// and looks in part like what the unknown does.
    pub fn sd_beside_misfit(&self, id: UnknownId, floor: f64) -> f64 {
        let left = (self.train.rms.powi(2) - floor.powi(2)).max(0.0).sqrt();
        let misfit = thresholds::MISFIT_ALIKE * left * self.by_alike_misfit[id];
        self.wider_sd[id].hypot(misfit)
    }

    /// Unknowns to begin with where something is added: parameters and sensors that took up what
    /// it does begin anew.
    pub fn restarted(&self) -> Vec<f64> {
        let known = self.unknowns.iter().zip(&self.train.estimate.theta);
        known
            .map(|(unknown, value)| unknown.prior.map_or(*value, |prior| prior.mean))
            .collect()
    }

    /// What was estimated, with which it is.
    pub fn unknowns(&self) -> impl Iterator<Item = (UnknownId, &Unknown)> {
        UnknownId::first(self.unknowns.len()).zip(&self.unknowns)
    }

    /// The values of some unknowns as a specification states them, SI.
    pub fn stated(&self, unknowns: &[UnknownId]) -> Vec<f64> {
        let theta = &self.train.estimate.theta;
        let of = |id: &UnknownId| self.unknowns[*id].what.stated(theta[*id]);
        unknowns.iter().map(of).collect()
    }

    /// The training windows to be explained by the fit's own model.
    pub fn shooting<'a>(&'a self, problem: &'a EstimationProblem<'a>) -> Shooting<'a> {
        Shooting::new(
            problem,
            &self.model,
            &problem.train,
            &self.unknowns,
            &self.ranges,
        )
    }

    /// A state of the fit's model as one of another model: states that only the other has are 0.
    pub fn mapped(&self, model: &EstimationModel, state: &[f64]) -> Vec<f64> {
        if state.is_empty() {
            return Vec::new();
        }
        model.mapped(&self.model, state)
    }

    /// Whether it leaves no more than a right model would.
    pub fn is_at_floor(&self, floor: f64) -> bool {
        self.leaves_less(thresholds::AT_FLOOR * floor)
    }

    /// Whether it leaves less than so many standard deviations, on both sets of records.
    pub fn leaves_less(&self, rms: f64) -> bool {
        self.train.rms.max(self.test.rms) < rms
    }

    /// Whether it leaves less than another by what is asked of an effect, on both sets of records.
    pub fn leaves_clearly_less(&self, other: &Self) -> bool {
        let better = 1.0 - thresholds::HELD_OUT;
        self.train.rms < better * other.train.rms && self.test.rms < better * other.test.rms
    }
}
