//! Shapes, such as the speed at which friction has fallen, tried at other sizes: a fit that began
//! at the usual one may end in a minimum of its own.

use crate::search::fitted::{FittedHypothesis, full_fits};
use crate::search::hypothesis::{Hypothesis, shaped_as};
use crate::search::pool::Pool;
use crate::thresholds;

/// Fits what has a shape, helps and does not reach the floor from other shapes, and takes over
/// what is accepted, or leaves less.
pub fn reshape(pool: &Pool<'_>, trials: &mut [FittedHypothesis]) {
    let is_there = |trial: &FittedHypothesis| {
        trial.verdict.is_ok() && trial.fit.is_at_floor(pool.context.floor)
    };
    if trials.iter().any(is_there) {
        return;
    }
    let wanted = trials.iter_mut().filter(|trial| {
        let has_shape = trial.own.iter().any(|own| own.is_shape);
        has_shape && trial.fit.leaves_clearly_less(pool.context.fit)
    });
    for trial in wanted {
        let sizes = trial.responses.iter();
        let sizes = sizes.flat_map(|r| pool.screening.responses[*r].values.clone());
        let set = Hypothesis {
            responses: trial.responses.clone(),
            deleted: None,
            sizes: sizes.collect(),
        };
        let preliminaries = thresholds::OTHER_SHAPES
            .iter()
            .filter_map(|times| Some((set.clone(), shaped_as(pool, &set, *times).ok()?)));
        let found = full_fits(pool, preliminaries.collect());
        for other in found {
            if is_better(&other, trial) {
                *trial = other;
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
