//! Single effects of pairs: if a pair explains the records and one of its effects is negligible
//! there, the other is fitted on its own from the end of the fit of the pair, because its earlier
//! fit may have ended in another minimum.

use crate::fit::preliminary::PreliminaryFit;
use crate::ids::{EffectId, ResponseId};
use crate::search::acceptance::{EffectUnknown, significance};
use crate::search::fitted::{FittedHypothesis, full_fits};
use crate::search::hypothesis::{Hypothesis, half_alone};
use crate::search::pool::Pool;
use crate::thresholds;

/// Fits the remaining effect of pairs with a negligible one, each effect once. Pairs with large
/// residuals, or that need both effects, are skipped.
pub fn halves_alone(pool: &Pool<'_>, pairs: &[FittedHypothesis]) -> Vec<FittedHypothesis> {
    let mut known: Vec<ResponseId> = Vec::new();
    let mut preliminaries = Vec::new();
    for pair in pairs {
        let Some(half) = needed(pool, pair) else {
            continue;
        };
        let response = pair.responses[half.index()];
        if known.contains(&response) {
            continue;
        }
        if let Some(found) = begun(pool, pair, half) {
            known.push(response);
            preliminaries.push(found);
        }
    }
    full_fits(pool, preliminaries)
}

/// The half of a pair that is needed, where the other is not.
fn needed(pool: &Pool<'_>, pair: &FittedHypothesis) -> Option<EffectId> {
    let little = thresholds::CLOSE * pool.context.floor;
    let has_terms = |response: &ResponseId| {
        let response = &pool.screening.responses[*response];
        response.dropped_prior.is_none()
    };
    let is_pair = pair.responses.len() == 2 && pair.responses.iter().all(has_terms);
    if !is_pair || pair.verdict.is_ok() || !pair.fit.leaves_less(little) {
        return None;
    }
    let is_needed = |effect: &EffectId| {
        let of = |own: &&EffectUnknown| own.effect == *effect && !own.is_shape;
        let mut own = pair.own.iter().filter(of);
        let is_free = own.all(|own| !pair.fit.is_held(own.unknown));
        is_free && significance(&pair.fit, &pair.own, *effect) >= thresholds::SIGNIFICANCE
    };
    let needed: Vec<EffectId> = EffectId::first(2).filter(is_needed).collect();
    match needed[..] {
        [only] => Some(only),
        _ => None,
    }
}

/// A half of a pair, begun where the pair ended.
fn begun(
    pool: &Pool<'_>,
    pair: &FittedHypothesis,
    half: EffectId,
) -> Option<(Hypothesis, PreliminaryFit)> {
    let theta = &pair.fit.train.estimate.theta;
    let own = pair.own.iter().filter(|own| own.effect == half);
    let own: Vec<&EffectUnknown> = own.collect();
    let scaling = own.iter().filter(|own| !own.is_shape);
    let hypothesis = Hypothesis {
        responses: vec![pair.responses[half.index()]],
        deleted: None,
        sizes: scaling.map(|own| theta[own.unknown] - own.base).collect(),
    };
    let values: Vec<f64> = own.iter().map(|own| theta[own.unknown]).collect();
    let preliminary = half_alone(pool, &hypothesis, &pair.fit, &values).ok()?;
    Some((hypothesis, preliminary))
}
