//! Acceptance test: improvement of a fit that a further effect must achieve. All limits are in
//! [`crate::thresholds`].

use crate::fit::fit_result::Fit;
use crate::ids::{EffectId, UnknownId};
use crate::search::rejection::Rejection;
use crate::thresholds;

/// Test statistics of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct TestStatistics {
    /// Relative reduction of the gap of the test records.
    pub held_out_reduction: f64,
    /// Reduction of the squares of the test records, in standard errors over blocks of time.
    pub reduction_in_standard_errors: f64,
    /// Half the reduction of the whitened sum of squares of the training records.
    pub information_gain: f64,
    /// Size of the effect in standard deviations; for several effects, the smallest.
    pub t_value: f64,
    /// Influence of the effect on the channel that shows it best, in standard deviations of the
    /// noise.
    pub size_over_noise: f64,
    /// P-value of the test records; `None` if it was not computed.
    pub p_value: Option<f64>,
}

/// Unknown of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectUnknown {
    /// Index among the unknowns of the fit.
    pub unknown: UnknownId,
    /// Index of its effect among the tested effects.
    pub effect: EffectId,
    /// Value without the effect, SI.
    pub base: f64,
    /// True for a shape parameter, which does not scale the effect.
    pub is_shape: bool,
    /// Standard deviation of its removed prior, SI.
    pub dropped_prior_sd: Option<f64>,
}

/// Tests a fit with additional effects, given by their unknowns.
///
/// # Errors
///
/// The reason for the rejection.
pub fn test_acceptance(
    before: &Fit,
    after: &Fit,
    own: &[EffectUnknown],
) -> Result<TestStatistics, Rejection> {
    let statistics = test_explanation(before, after, own)?;
    // The value must be outside the range of the prior even after subtraction of its uncertainty.
    if let Some(rejection) = check_priors(after, own, thresholds::MIN_REDUCTION_STANDARD_ERRORS) {
        return Err(rejection);
    }
    if statistics.t_value < thresholds::MIN_SIGNIFICANCE {
        return Err(Rejection::Significance(statistics.t_value));
    }
    // The influence is not tested for an effect that removes a prior: its part outside the prior's
    // range may be small.
    let has_prior = own.iter().all(|own| own.dropped_prior_sd.is_some());
    if !has_prior && statistics.size_over_noise < thresholds::MIN_EFFECT_OVER_NOISE {
        return Err(Rejection::Influence(statistics.size_over_noise));
    }
    Ok(statistics)
}

/// Tests if additional effects explain the records better. Their sizes may be uncertain because a
/// declared nuisance has the same response.
///
/// # Errors
///
/// The failed criterion.
pub fn test_explanation(
    before: &Fit,
    after: &Fit,
    own: &[EffectUnknown],
) -> Result<TestStatistics, Rejection> {
    let statistics = compute_test_statistics(before, after, own);
    if let Some(rejection) = check_bounds(after, own).or_else(|| check_priors(after, own, 0.0)) {
        return Err(rejection);
    }
    if statistics.held_out_reduction < thresholds::MIN_HELD_OUT_REDUCTION {
        return Err(Rejection::HeldOut(statistics.held_out_reduction));
    }
    if statistics.reduction_in_standard_errors < thresholds::MIN_REDUCTION_STANDARD_ERRORS {
        return Err(Rejection::StandardErrors(
            statistics.reduction_in_standard_errors,
        ));
    }
    if statistics.information_gain < thresholds::MIN_INFORMATION_GAIN {
        return Err(Rejection::Information {
            gain: statistics.information_gain,
            required: thresholds::MIN_INFORMATION_GAIN,
        });
    }
    Ok(statistics)
}

/// Computes the test statistics of additional effects, given by their unknowns.
pub fn compute_test_statistics(before: &Fit, after: &Fit, own: &[EffectUnknown]) -> TestStatistics {
    let (old, new) = (&before.test, &after.test);
    let falls: Vec<f64> = (old.block_squares.iter().zip(&new.block_squares))
        .map(|(a, b)| a.sqrt() - b.sqrt())
        .collect();
    let count = falls.len() as f64;
    let mean = falls.iter().sum::<f64>() / count;
    let variance = falls.iter().map(|f| (f - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    let fall = before.train.block_squares.iter().sum::<f64>()
        - after.train.block_squares.iter().sum::<f64>();
    let whitening = after.train.variance_inflation();
    TestStatistics {
        held_out_reduction: 1.0 - new.rms / old.rms,
        reduction_in_standard_errors: mean / (variance / count).sqrt(),
        information_gain: fall / (2.0 * whitening),
        t_value: compute_least_significance(after, own),
        size_over_noise: compute_influence(before, after),
        p_value: None,
    }
}

/// Returns the reduction of the RMS residual by the effect, in standard deviations, for the channel
/// and the records that show it best.
fn compute_influence(before: &Fit, after: &Fit) -> f64 {
    let channels = |of: fn(&Fit) -> &Vec<f64>| of(before).iter().zip(of(after));
    let both =
        channels(|fit| &fit.train.normalised_rms).chain(channels(|fit| &fit.test.normalised_rms));
    let sizes = both.map(|(old, new)| (old * old - new * new).max(0.0).sqrt());
    sizes.fold(0.0, f64::max)
}

/// Returns the size of an effect in standard deviations; for several effects, the smallest. Sine
/// and cosine of a wave count as one effect.
fn compute_least_significance(fit: &Fit, own: &[EffectUnknown]) -> f64 {
    let effects = own.iter().map(|own| own.effect.index() + 1).max();
    EffectId::first(effects.unwrap_or(0))
        .map(|effect| compute_t_value(fit, own, effect))
        .fold(f64::INFINITY, f64::min)
}

/// Returns the size of one tested effect in standard deviations.
pub fn compute_t_value(fit: &Fit, own: &[EffectUnknown], effect: EffectId) -> f64 {
    let scaling = own
        .iter()
        .filter(|own| own.effect == effect && !own.is_shape);
    let ratios = scaling
        .map(|own| (fit.train.estimate.theta[own.unknown] - own.base) / fit.effect_sd[own.unknown]);
    ratios.map(|t| t * t).sum::<f64>().sqrt()
}

/// Returns true if a shape parameter does not differ significantly from 0. The effect is then
/// equivalent to an effect without this parameter: a spring that softens beyond a deflection of 0
/// is a softer spring.
pub fn has_vanishing_shape(fit: &Fit, own: &[EffectUnknown]) -> bool {
    let mut shapes = own.iter().filter(|own| own.is_shape);
    shapes.any(|own| {
        let shape = fit.train.estimate.theta[own.unknown].abs();
        shape < thresholds::MIN_REDUCTION_STANDARD_ERRORS * fit.effect_sd[own.unknown]
    })
}

/// Returns a rejection if a parameter is at its bound.
fn check_bounds(fit: &Fit, own: &[EffectUnknown]) -> Option<Rejection> {
    let held = own
        .iter()
        .find(|own| !own.is_shape && fit.is_at_bound(own.unknown))?;
    let name = fit.unknowns[held.unknown].label.clone();
    Some(match held.dropped_prior_sd {
        Some(_) => Rejection::AtLimit(name),
        None => Rejection::WrongSign(name),
    })
}

/// Returns a rejection if an unknown whose prior was removed is still within the range of the
/// prior. The distance from the prior mean is reduced by `errors` standard errors.
fn check_priors(fit: &Fit, own: &[EffectUnknown], errors: f64) -> Option<Rejection> {
    own.iter().find_map(|own| {
        let prior = own.dropped_prior_sd?;
        let deviation = (fit.train.estimate.theta[own.unknown] - own.base).abs() / prior;
        let sd = fit.effect_sd[own.unknown] / prior;
        let is_beyond_prior = deviation - errors * sd > thresholds::MAX_PRIOR_DEVIATION;
        (!is_beyond_prior).then(|| Rejection::WithinPrior {
            name: fit.unknowns[own.unknown].label.clone(),
            deviation,
            sd,
        })
    })
}
