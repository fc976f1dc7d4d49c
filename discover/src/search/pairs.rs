//! Pairs of candidates with a much better prediction than single candidates, and replacements of
//! one effect of a pair.

use crate::ids::{FittedId, ResponseId, UnknownId};
use crate::model::unknowns::UnknownKind;
use crate::search::acceptance::EffectUnknown;
use crate::search::hypothesis::Hypothesis;
use crate::search::hypothesis_fits::{FittedHypothesis, run_full_fits, run_preliminary_fits};
use crate::search::pair_halves::fit_halves;
use crate::search::pool::CandidatePool;
use crate::search::rejection::Rejection;
use crate::search::screening::{LinearPrediction, Screening};
use crate::thresholds;

/// Fits pairs of candidates, and pairs that replace a term of the model. `singles`: fitted single
/// candidates.
pub fn fit_pairs(pool: &CandidatePool<'_>, singles: &[FittedHypothesis]) -> Vec<FittedHypothesis> {
    // A sensor at the bound of its range compensates for another error and is not paired.
    let is_at_limit = |fitted: &&FittedHypothesis| {
        let of = |own: &EffectUnknown| {
            own.dropped_prior_sd.is_some() && fitted.fit.is_at_bound(own.unknown)
        };
        fitted.effect_unknowns.iter().any(of)
    };
    let at_limit = singles.iter().filter(is_at_limit);
    let at_limit: Vec<ResponseId> = at_limit
        .flat_map(|fitted| fitted.responses.clone())
        .collect();
    let is_there = |response: &ResponseId| !at_limit.contains(response);
    let ranking: Vec<ResponseId> = pool.rank_responses().into_iter().filter(is_there).collect();
    let mut added = 0;
    let mut preliminaries =
        run_preliminary_fits(pool, select_best_pairs(pool, &ranking, &at_limit));
    preliminaries.retain(|(hypothesis, _)| {
        added += usize::from(hypothesis.replaced_parameter.is_none());
        hypothesis.replaced_parameter.is_some() || added <= thresholds::PARALLEL_FIT_COUNT
    });
    let mut fitted_hypotheses = run_full_fits(pool, preliminaries);
    let alone = fit_halves(pool, &fitted_hypotheses);
    fitted_hypotheses.extend(alone);
    for fitted in &mut fitted_hypotheses {
        let mut own = fitted.responses.iter();
        let repeats = own.any(|response| pool.candidate(*response).angle_order.is_some());
        if repeats && fitted.verdict.is_ok() && !pool.context.explains_most_of_gap(&fitted.fit) {
            fitted.verdict = Err(Rejection::LargeRemainder);
            fitted.explains_records = false;
        }
    }
    fitted_hypotheses
}

/// Returns the pairs with a predicted residual clearly below that of the best single candidate. For
/// each term of the model that may be deleted, also returns the pair that replaces it best.
/// Periodic candidates are so numerous that some fit by chance: only the best are paired, and only
/// with other candidates.
fn select_best_pairs(
    pool: &CandidatePool<'_>,
    ranking: &[ResponseId],
    at_limit: &[ResponseId],
) -> Vec<Hypothesis> {
    let screening = pool.screening;
    let best = ranking
        .first()
        .map_or(0.0, |r| screening.responses[*r].cost_decrease);
    let single = screening.predict(&[]).cost - best;
    // A candidate may be useful only in a pair: two kinds of friction may replace a third one.
    let repeats = |r: &ResponseId| pool.candidate(*r).angle_order.is_some();
    let repeating: Vec<ResponseId> = (ranking.iter().copied().filter(repeats))
        .take(thresholds::MAX_FULL_FITS_PER_ROUND)
        .collect();
    let few: Vec<ResponseId> = ResponseId::first(screening.responses.len())
        .filter(|r| {
            let response = &screening.responses[*r];
            let is_one = !repeats(r) || repeating.contains(r);
            is_one
                && !at_limit.contains(r)
                && response.unexplained_fraction > thresholds::MIN_UNEXPLAINED_FRACTION
        })
        .collect();
    let never = |a: ResponseId, b: ResponseId| {
        pool.has_common_parameter_name(a, b) || (repeats(&a) && repeats(&b))
    };
    let best_of = |deleted: Option<UnknownId>, screening: &Screening| {
        let mut found: Vec<(f64, Hypothesis)> = Vec::new();
        for (number, a) in few.iter().enumerate() {
            let others = few[number + 1..].iter();
            for b in others.filter(|b| !never(*a, **b)) {
                let responses = vec![*a, *b];
                let LinearPrediction { cost, sizes } = screening.predict(&responses);
                // If a term is replaced, the linear prediction is not used, because the change is
                // too large.
                let is_worth_fitting =
                    deleted.is_some() || cost < thresholds::MAX_PAIR_COST_RATIO * single;
                if is_worth_fitting
                    && sizes.iter().all(|v| *v != 0.0)
                    && !screening.is_cancelling(&responses, &sizes)
                {
                    let hypothesis = Hypothesis {
                        responses,
                        replaced_parameter: deleted,
                        predicted_sizes: sizes,
                    };
                    found.push((cost, hypothesis));
                }
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let count = match deleted {
            Some(_) => 1,
            None => thresholds::MAX_PRELIMINARY_FITS,
        };
        found
            .into_iter()
            .take(count)
            .map(|(_, hypothesis)| hypothesis)
            .collect::<Vec<Hypothesis>>()
    };
    let mut hypotheses = best_of(None, screening);
    for (id, unknown) in pool.context.fit.unknowns() {
        let value = pool.context.fit.train.estimate.theta[id];
        let near = unknown
            .prior
            .is_some_and(|prior| prior.mean.abs() < thresholds::MAX_PRIOR_SD_TO_ZERO * prior.sd);
        if matches!(unknown.kind, UnknownKind::Parameter(_))
            && near
            && let Some(screening) = screening.with_nuisance_fixed_at(id, value)
        {
            hypotheses.extend(best_of(Some(id), &screening));
        }
    }
    hypotheses
}

/// Fits pairs that share one effect with a given pair and whose other effect is similar to the
/// other effect of this pair. If the gap of the pair exceeds that of a correct model, its effect at
/// other sites is fitted too. At most [`thresholds::PARALLEL_FIT_COUNT`] new pairs are fitted, the
/// most similar first.
pub fn fit_other_halves(
    pool: &CandidatePool<'_>,
    fitted_hypotheses: &[FittedHypothesis],
    pair: FittedId,
) -> Vec<FittedHypothesis> {
    let [a, b] = fitted_hypotheses[pair].responses[..] else {
        return Vec::new();
    };
    let mut found: Vec<(f64, Vec<ResponseId>)> = Vec::new();
    let at_floor = fitted_hypotheses[pair].fit.is_at_floor(pool.context.floor);
    for (kept, other) in [(a, b), (b, a)] {
        for response in ResponseId::first(pool.screening.responses.len()) {
            let is_new = ![kept, other].contains(&response)
                && !pool.has_common_parameter_name(kept, response)
                && pool.candidate(response).angle_order.is_none();
            let is_distinct = pool.screening.responses[response].unexplained_fraction
                > thresholds::MIN_UNEXPLAINED_FRACTION;
            let similarity = match is_new && is_distinct {
                true => pool.screening.compute_similarity(other, response),
                false => 0.0,
            };
            let pair = vec![kept, response];
            let is_known = |fitted: &FittedHypothesis| {
                fitted.responses.len() == 2 && pair.iter().all(|r| fitted.responses.contains(r))
            };
            let is_same = pool.candidate(response).effect == pool.candidate(other).effect;
            let may_be = similarity > thresholds::MIN_SIMILARITY_OF_RIVALS
                || (!at_floor && is_same && similarity > 0.0);
            if may_be && !fitted_hypotheses.iter().any(is_known) {
                found.push((similarity, pair));
            }
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(thresholds::PARALLEL_FIT_COUNT);
    let hypothesis = |(_, responses): (f64, Vec<ResponseId>)| Hypothesis {
        predicted_sizes: pool.screening.predict(&responses).sizes,
        responses,
        replaced_parameter: None,
    };
    let hypotheses = found.into_iter().map(hypothesis).collect();
    let mut fitted_hypotheses = run_full_fits(pool, run_preliminary_fits(pool, hypotheses));
    let alone = fit_halves(pool, &fitted_hypotheses);
    fitted_hypotheses.extend(alone);
    fitted_hypotheses
}

/// Fits pairs in which another candidate of the pool replaces one effect of a pair. Their predicted
/// residual must be nearly as low. At most [`thresholds::MAX_FULL_FITS_PER_ROUND`] pairs are tried
/// for each replaced effect, the best first; pairs with a good preliminary fit are fitted in full.
pub fn fit_replacements(pool: &CandidatePool<'_>, pair: &[ResponseId]) -> Vec<FittedHypothesis> {
    let hypothesis = |responses: Vec<ResponseId>| {
        let LinearPrediction { cost, sizes } = pool.screening.predict(&responses);
        let hypothesis = Hypothesis {
            responses,
            replaced_parameter: None,
            predicted_sizes: sizes,
        };
        (cost, hypothesis)
    };
    let (cost, own) = hypothesis(pair.to_vec());
    let mut hypotheses = vec![own];
    for half in 0..pair.len() {
        let others = ResponseId::first(pool.screening.responses.len());
        let others = others.filter(|other| {
            let mut kept = pair.iter().filter(|kept| **kept != pair[half]);
            !pair.contains(other) && kept.all(|kept| !pool.has_common_parameter_name(*kept, *other))
        });
        let replaced = others.map(|other| {
            let mut responses = pair.to_vec();
            responses[half] = other;
            hypothesis(responses)
        });
        let mut found: Vec<(f64, Hypothesis)> = replaced
            .filter(|(other, _)| *other < thresholds::MAX_RIVAL_COST_RATIO * cost)
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.truncate(thresholds::MAX_FULL_FITS_PER_ROUND);
        hypotheses.extend(found.into_iter().map(|(_, hypothesis)| hypothesis));
    }
    if hypotheses.len() == 1 {
        return Vec::new();
    }
    let mut preliminaries = run_preliminary_fits(pool, hypotheses);
    let own = preliminaries
        .iter()
        .find(|(hypothesis, _)| hypothesis.responses == pair);
    let most = own.map_or(0.0, |(_, own)| thresholds::MAX_RIVAL_COST_RATIO * own.cost);
    preliminaries.retain(|(hypothesis, preliminary)| {
        hypothesis.responses != pair && preliminary.cost < most
    });
    run_full_fits(pool, preliminaries)
}
