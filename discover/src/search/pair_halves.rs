//! Single effects of pairs. If a pair explains the records and one of its effects is negligible,
//! the other effect is fitted separately. This fit starts from the estimates of the pair, because
//! an earlier fit of the effect may have ended in another minimum.

use crate::fit::preliminary_fit::PreliminaryFit;
use crate::ids::{EffectId, ResponseId};
use crate::search::acceptance::{EffectUnknown, compute_t_value};
use crate::search::hypothesis::{Hypothesis, fit_half_from_pair};
use crate::search::hypothesis_fits::{FittedHypothesis, run_full_fits};
use crate::search::pool::CandidatePool;
use crate::thresholds;

/// Fits the remaining effect of pairs with one negligible effect; each effect is fitted only once.
/// Pairs with large residuals or with two necessary effects are skipped.
pub fn fit_halves(pool: &CandidatePool<'_>, pairs: &[FittedHypothesis]) -> Vec<FittedHypothesis> {
    let mut known: Vec<ResponseId> = Vec::new();
    let mut preliminaries = Vec::new();
    for pair in pairs {
        let Some(half) = find_necessary_half(pool, pair) else {
            continue;
        };
        let response = pair.responses[half.index()];
        if known.contains(&response) {
            continue;
        }
        if let Some(found) = start_half(pool, pair, half) {
            known.push(response);
            preliminaries.push(found);
        }
    }
    run_full_fits(pool, preliminaries)
}

/// Returns the only necessary effect of a pair; `None` if both or none are necessary.
fn find_necessary_half(pool: &CandidatePool<'_>, pair: &FittedHypothesis) -> Option<EffectId> {
    let little = thresholds::MAX_FLOOR_RATIO_TO_STOP * pool.context.floor;
    let has_terms = |response: &ResponseId| {
        let response = &pool.screening.responses[*response];
        response.dropped_prior.is_none()
    };
    let is_pair = pair.responses.len() == 2 && pair.responses.iter().all(has_terms);
    if !is_pair || pair.verdict.is_ok() || !pair.fit.is_below(little) {
        return None;
    }
    let is_needed = |effect: &EffectId| {
        let of = |own: &&EffectUnknown| own.effect == *effect && !own.is_shape;
        let mut own = pair.effect_unknowns.iter().filter(of);
        let is_free = own.all(|own| !pair.fit.is_at_bound(own.unknown));
        is_free
            && compute_t_value(&pair.fit, &pair.effect_unknowns, *effect)
                >= thresholds::MIN_SIGNIFICANCE
    };
    let needed: Vec<EffectId> = EffectId::first(2).filter(is_needed).collect();
    match needed[..] {
        [only] => Some(only),
        _ => None,
    }
}

/// Runs a preliminary fit of one effect of a pair, starting from the estimates of the pair.
fn start_half(
    pool: &CandidatePool<'_>,
    pair: &FittedHypothesis,
    half: EffectId,
) -> Option<(Hypothesis, PreliminaryFit)> {
    let theta = &pair.fit.train.estimate.theta;
    let own = pair.effect_unknowns.iter().filter(|own| own.effect == half);
    let own: Vec<&EffectUnknown> = own.collect();
    let scaling = own.iter().filter(|own| !own.is_shape);
    let hypothesis = Hypothesis {
        responses: vec![pair.responses[half.index()]],
        replaced_parameter: None,
        predicted_sizes: scaling.map(|own| theta[own.unknown] - own.base).collect(),
    };
    let values: Vec<f64> = own.iter().map(|own| theta[own.unknown]).collect();
    let preliminary = fit_half_from_pair(pool, &hypothesis, &pair.fit, &values).ok()?;
    Some((hypothesis, preliminary))
}
