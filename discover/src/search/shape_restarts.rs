//! Repeated fits with other initial values of shape parameters, such as the Stribeck speed. A fit
//! from the typical value may end in a local minimum.

use crate::search::hypothesis::{Hypothesis, fit_with_shape_factor};
use crate::search::hypothesis_fits::{FittedHypothesis, run_full_fits};
use crate::search::pool::CandidatePool;
use crate::thresholds;

/// Fits hypotheses with a shape parameter again from other shapes, if they explain much but do not
/// reach the noise floor. Accepted results and lower residuals are kept.
pub fn restart_shapes(pool: &CandidatePool<'_>, fitted_hypotheses: &mut [FittedHypothesis]) {
    let is_there = |fitted: &FittedHypothesis| {
        fitted.verdict.is_ok() && fitted.fit.is_at_floor(pool.context.floor)
    };
    if fitted_hypotheses.iter().any(is_there) {
        return;
    }
    let wanted = fitted_hypotheses.iter_mut().filter(|fitted| {
        let has_shape = fitted.effect_unknowns.iter().any(|own| own.is_shape);
        has_shape && fitted.fit.is_clearly_below(pool.context.fit)
    });
    for fitted in wanted {
        let sizes = fitted.responses.iter();
        let sizes = sizes.flat_map(|r| pool.screening.responses[*r].sizes.clone());
        let hypothesis = Hypothesis {
            responses: fitted.responses.clone(),
            replaced_parameter: None,
            predicted_sizes: sizes.collect(),
        };
        let preliminaries = thresholds::SHAPE_RESTART_FACTORS
            .iter()
            .filter_map(|times| {
                Some((
                    hypothesis.clone(),
                    fit_with_shape_factor(pool, &hypothesis, *times).ok()?,
                ))
            });
        let found = run_full_fits(pool, preliminaries.collect());
        for other in found {
            if is_better(&other, fitted) {
                *fitted = other;
            }
        }
    }
}

/// Returns true if only the first of two fitted hypotheses is accepted; otherwise, if its residual
/// is smaller.
fn is_better(one: &FittedHypothesis, other: &FittedHypothesis) -> bool {
    match (one.verdict.is_ok(), other.verdict.is_ok()) {
        (true, false) => true,
        (false, true) => false,
        _ => one.fit.rms() < other.fit.rms(),
    }
}
