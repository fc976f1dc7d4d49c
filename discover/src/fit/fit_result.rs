//! Fitted specification: estimates, uncertainties and residuals. The algorithm is in
//! [`crate::fit::full_fit`].

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
    /// Texts of the specification.
    pub texts: SpecificationTexts,
    /// Compiled model.
    pub model: EstimationModel,
    /// Unknowns of the fit.
    pub unknowns: Vec<Unknown>,
    /// Standard deviation of each unknown for a correct model. It includes the correlation of
    /// residuals, but not the priors from preceding windows.
    pub sd: Vec<f64>,
    /// Standard deviation of each unknown for the test of effects. It is larger by
    /// [`thresholds::UNCERTAINTY_FACTOR`], because the model may be incorrect.
    pub effect_sd: Vec<f64>,
    /// Error of each unknown due to a misfit that resembles the response of the unknown, with one
    /// standard deviation of the noise in each sample.
    pub misfit_sensitivity: Vec<f64>,
    /// Range of each state.
    pub ranges: Vec<f64>,
    /// Prior of the initial states of the training windows.
    pub prior: InitialStatePrior,
    /// Weight of the priors.
    pub prior_weight: f64,
    /// Residuals of the training records.
    pub train: Residuals,
    /// Residuals of the test records.
    pub test: Residuals,
}

impl Fit {
    /// Returns true if an unknown is at one of its bounds.
    pub fn is_at_bound(&self, id: UnknownId) -> bool {
        let (value, bounds) = (self.train.estimate.theta[id], self.unknowns[id].bounds);
        value <= bounds.low || value >= bounds.high
    }

    /// Returns the RMS residual of all records, in standard deviations.
    pub fn rms(&self) -> f64 {
        (0.5 * (self.train.rms.powi(2) + self.test.rms.powi(2))).sqrt()
    }

    /// Returns the reported standard deviation of an unknown. It includes the possible error due to
    /// the misfit above `floor`, the noise floor in standard deviations. The misfit is not noise
    /// and may resemble the response of the unknown.
    pub fn sd_with_misfit(&self, id: UnknownId, floor: f64) -> f64 {
        let left = (self.train.rms.powi(2) - floor.powi(2)).max(0.0).sqrt();
        let misfit = thresholds::MISFIT_SIMILARITY * left * self.misfit_sensitivity[id];
        self.effect_sd[id].hypot(misfit)
    }

    /// Returns initial values of the unknowns for a fit with a further effect. Parameters and
    /// sensors that imitated the effect are reset.
    pub fn restart_values(&self) -> Vec<f64> {
        let known = self.unknowns.iter().zip(&self.train.estimate.theta);
        known
            .map(|(unknown, value)| unknown.prior.map_or(*value, |prior| prior.mean))
            .collect()
    }

    /// Returns the unknowns with their indices.
    pub fn unknowns(&self) -> impl Iterator<Item = (UnknownId, &Unknown)> {
        UnknownId::first(self.unknowns.len()).zip(&self.unknowns)
    }

    /// Returns the values of unknowns in the form used in the specification, SI.
    pub fn values_in_specification(&self, unknowns: &[UnknownId]) -> Vec<f64> {
        let theta = &self.train.estimate.theta;
        let of = |id: &UnknownId| self.unknowns[*id].kind.value_in_specification(theta[*id]);
        unknowns.iter().map(of).collect()
    }

    /// Returns the shooting problem of the training windows.
    pub fn training_shooting<'a>(&'a self, problem: &'a EstimationProblem<'a>) -> Shooting<'a> {
        Shooting::new(
            problem,
            &self.model,
            &problem.train,
            &self.unknowns,
            &self.ranges,
        )
    }

    /// Converts a state of this model to a state of another model. States that exist only in the
    /// other model are 0.
    pub fn map_state(&self, model: &EstimationModel, state: &[f64]) -> Vec<f64> {
        if state.is_empty() {
            return Vec::new();
        }
        model.map_state(&self.model, state)
    }

    /// Returns true if the residuals of the training and test records are within the limit for a
    /// correct model. `floor`: noise floor, in standard deviations.
    ///
    /// The squares of a correct model have a chi-squared distribution with as many degrees of
    /// freedom as there are squares in the noise floor. Those of the test records are larger
    /// because of the uncertainty of the unknowns.
    pub fn is_at_floor(&self, floor: f64) -> bool {
        let freedom = |of: &Residuals| (of.measurement_count * floor.powi(2).min(1.0)).max(1.0);
        let (train, test) = (freedom(&self.train), freedom(&self.test));
        let by_unknowns = f64::sqrt(1.0 + self.count_determined_unknowns() / train);
        self.train.rms < floor * compute_largest_chance_ratio(train)
            && self.test.rms < floor * by_unknowns * compute_largest_chance_ratio(test)
    }

    /// Returns the number of unknowns that the records determine: the sum of the fractions of prior
    /// variance that the records remove.
    fn count_determined_unknowns(&self) -> f64 {
        let of = |(unknown, sd): (&Unknown, &f64)| {
            let left = unknown.prior.map_or(0.0, |prior| sd / prior.sd);
            (1.0 - left * left).clamp(0.0, 1.0)
        };
        self.unknowns.iter().zip(&self.sd).map(of).sum()
    }

    /// Returns true if the RMS residuals of the training and test records are below `rms` standard
    /// deviations.
    pub fn is_below(&self, rms: f64) -> bool {
        self.train.rms.max(self.test.rms) < rms
    }

    /// Returns true if the residual is smaller than the residual of another fit by the margin of an
    /// accepted effect, on training and test records.
    pub fn is_clearly_below(&self, other: &Self) -> bool {
        let better = 1.0 - thresholds::MIN_HELD_OUT_REDUCTION;
        self.train.rms < better * other.train.rms && self.test.rms < better * other.test.rms
    }
}

/// Returns the largest RMS residual of a correct model, in noise floors. It is exceeded with the
/// probability of [`thresholds::FALSE_ALARM_QUANTILE`].
fn compute_largest_chance_ratio(freedom: f64) -> f64 {
    let quantile = compute_chi_squared_quantile(freedom, thresholds::FALSE_ALARM_QUANTILE);
    (quantile / freedom)
        .sqrt()
        .max(thresholds::MAX_FLOOR_RATIO_AT_FLOOR)
}

/// Converts a quantile of the normal distribution to the quantile of the chi-squared distribution
/// with the same probability, by the approximation of Wilson and Hilferty (1931).
fn compute_chi_squared_quantile(freedom: f64, normal: f64) -> f64 {
    let variance = 2.0 / (9.0 * freedom);
    freedom * (1.0 - variance + normal * variance.sqrt()).powi(3)
}

#[cfg(test)]
mod tests {
    use super::{compute_chi_squared_quantile, compute_largest_chance_ratio};
    use crate::thresholds;

    #[test]
    fn quantile_of_chi_squared_matches_tables() {
        // 99 % quantiles: 23.209, 76.154 and 1106.969 for 10, 50 and 1000 degrees of freedom.
        for (freedom, right) in [(10.0, 23.209), (50.0, 76.154), (1000.0, 1106.969)] {
            let found = compute_chi_squared_quantile(freedom, thresholds::FALSE_ALARM_QUANTILE);
            assert!((found / right - 1.0).abs() < 5e-3, "{freedom}: {found}");
        }
    }

    #[test]
    fn short_records_have_a_wider_limit() {
        // Expected values: sqrt(76.154/50), and the limit of long records.
        assert!((compute_largest_chance_ratio(50.0) - 1.2341).abs() < 1e-3);
        assert_eq!(
            compute_largest_chance_ratio(1e5),
            thresholds::MAX_FLOOR_RATIO_AT_FLOOR
        );
    }
}
