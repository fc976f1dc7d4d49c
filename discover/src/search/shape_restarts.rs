//! Restarts of shape parameters, such as the Stribeck speed, from other sizes, because a fit from
//! the typical size may end in a local minimum.

use crate::search::fitted::{FittedHypothesis, full_fits};
use crate::search::hypothesis::{Hypothesis, with_shape};
use crate::search::pool::Pool;
use crate::thresholds;

/// Fits promising hypotheses with a shape parameter again from other shapes if they do not reach
/// the noise floor. Accepted results and lower residuals are kept.
pub fn reshape(pool: &Pool<'_>, fitted_hypotheses: &mut [FittedHypothesis]) {
    let is_there = |fitted: &FittedHypothesis| {
        fitted.verdict.is_ok() && fitted.fit.is_at_floor(pool.context.floor)
    };
    if fitted_hypotheses.iter().any(is_there) {
        return;
    }
    let wanted = fitted_hypotheses.iter_mut().filter(|fitted| {
        let has_shape = fitted.own.iter().any(|own| own.is_shape);
        has_shape && fitted.fit.leaves_clearly_less(pool.context.fit)
    });
    for fitted in wanted {
        let sizes = fitted.responses.iter();
        let sizes = sizes.flat_map(|r| pool.screening.responses[*r].values.clone());
        let hypothesis = Hypothesis {
            responses: fitted.responses.clone(),
            deleted: None,
            sizes: sizes.collect(),
        };
        let preliminaries = thresholds::OTHER_SHAPES.iter().filter_map(|times| {
            Some((
                hypothesis.clone(),
                with_shape(pool, &hypothesis, *times).ok()?,
            ))
        });
        let found = full_fits(pool, preliminaries.collect());
        for other in found {
            if is_better(&other, fitted) {
                *fitted = other;
            }
        }
    }
}

/// Whether a fitted hypothesis is accepted where another is not, or else leaves less.
fn is_better(one: &FittedHypothesis, other: &FittedHypothesis) -> bool {
    match (one.verdict.is_ok(), other.verdict.is_ok()) {
        (true, false) => true,
        (false, true) => false,
        _ => one.fit.rms() < other.fit.rms(),
    }
}
