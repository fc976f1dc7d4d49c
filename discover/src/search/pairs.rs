//! Pairs of candidates: pairs with a much better prediction than single candidates, and
//! replacements of one effect of a pair.

use crate::ids::{FittedId, ResponseId, UnknownId};
use crate::model::unknowns::What;
use crate::search::acceptance::EffectUnknown;
use crate::search::fitted::{FittedHypothesis, full_fits, preliminary_fits};
use crate::search::halves_alone::halves_alone;
use crate::search::hypothesis::Hypothesis;
use crate::search::pool::Pool;
use crate::search::rejection::Rejection;
use crate::search::screening::{Prediction, Screening};
use crate::thresholds;

/// Fits pairs of candidates, and pairs that replace a term of the model. `singles`: fitted single
/// candidates.
pub fn pairs(pool: &Pool<'_>, singles: &[FittedHypothesis]) -> Vec<FittedHypothesis> {
    // A sensor that runs to the end of what is admitted stands in for something else.
    let is_at_limit = |fitted: &&FittedHypothesis| {
        let of = |own: &EffectUnknown| own.prior.is_some() && fitted.fit.is_held(own.unknown);
        fitted.own.iter().any(of)
    };
    let at_limit = singles.iter().filter(is_at_limit);
    let at_limit: Vec<ResponseId> = at_limit
        .flat_map(|fitted| fitted.responses.clone())
        .collect();
    let is_there = |response: &ResponseId| !at_limit.contains(response);
    let ranking: Vec<ResponseId> = pool.ranking().into_iter().filter(is_there).collect();
    let mut added = 0;
    let mut preliminaries = preliminary_fits(pool, best_pairs(pool, &ranking, &at_limit));
    preliminaries.retain(|(hypothesis, _)| {
        added += usize::from(hypothesis.deleted.is_none());
        hypothesis.deleted.is_some() || added <= thresholds::FITS_AT_ONCE
    });
    let mut fitted_hypotheses = full_fits(pool, preliminaries);
    let alone = halves_alone(pool, &fitted_hypotheses);
    fitted_hypotheses.extend(alone);
    for fitted in &mut fitted_hypotheses {
        let mut own = fitted.responses.iter();
        let repeats = own.any(|response| pool.candidate(*response).order.is_some());
        if repeats && fitted.verdict.is_ok() && !pool.context.explains_most(&fitted.fit) {
            fitted.verdict = Err(Rejection::LeavesMuch);
            fitted.explains = false;
        }
    }
    fitted_hypotheses
}

/// The pairs that promise to leave clearly less than the best single candidate, and for each term
/// of the model that may go the pair that takes its place best. Of what repeats with an angle the
/// best alone are paired, and with something else: of that there is so much that some of it is
/// lucky.
fn best_pairs(pool: &Pool<'_>, ranking: &[ResponseId], at_limit: &[ResponseId]) -> Vec<Hypothesis> {
    let screening = pool.screening;
    let best = ranking
        .first()
        .map_or(0.0, |r| screening.responses[*r].decrease);
    let single = screening.predicted(&[]).cost - best;
    // What is nothing alone may be half of a pair: friction of two kinds in place of a third.
    let repeats = |r: &ResponseId| pool.candidate(*r).order.is_some();
    let repeating: Vec<ResponseId> = (ranking.iter().copied().filter(repeats))
        .take(thresholds::MOST_FITS)
        .collect();
    let few: Vec<ResponseId> = ResponseId::first(screening.responses.len())
        .filter(|r| {
            let response = &screening.responses[*r];
            let is_one = !repeats(r) || repeating.contains(r);
            is_one
                && !at_limit.contains(r)
                && response.unexplained_fraction > thresholds::UNEXPLAINED_FRACTION
        })
        .collect();
    let never =
        |a: ResponseId, b: ResponseId| pool.share_a_name(a, b) || (repeats(&a) && repeats(&b));
    let best_of = |deleted: Option<UnknownId>, screening: &Screening| {
        let mut found: Vec<(f64, Hypothesis)> = Vec::new();
        for (number, a) in few.iter().enumerate() {
            let others = few[number + 1..].iter();
            for b in others.filter(|b| !never(*a, **b)) {
                let responses = vec![*a, *b];
                let Prediction { cost, sizes } = screening.predicted(&responses);
                // What replaces a term is far from where it was linearised: it is not held
                // to a promise.
                let promising = deleted.is_some() || cost < thresholds::PAIR_PROMISE * single;
                if promising
                    && sizes.iter().all(|v| *v != 0.0)
                    && !screening.cancels(&responses, &sizes)
                {
                    let hypothesis = Hypothesis {
                        responses,
                        deleted,
                        sizes,
                    };
                    found.push((cost, hypothesis));
                }
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let count = match deleted {
            Some(_) => 1,
            None => thresholds::MOST_PRELIMINARY_FITS,
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
            .is_some_and(|prior| prior.mean.abs() < thresholds::PRIOR_REACH * prior.sd);
        if matches!(unknown.what, What::Parameter(_))
            && near
            && let Some(screening) = screening.without(id, value)
        {
            hypotheses.extend(best_of(Some(id), &screening));
        }
    }
    hypotheses
}

/// Fits pairs that share one effect with a pair and whose other effect is similar to its other. If
/// the pair has a larger gap than a correct model, the same effect at other sites is fitted too.
/// The most similar are fitted first, at most [`thresholds::FITS_AT_ONCE`] and only new ones.
pub fn other_halves(
    pool: &Pool<'_>,
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
                && !pool.share_a_name(kept, response)
                && pool.candidate(response).order.is_none();
            let is_distinct = pool.screening.responses[response].unexplained_fraction
                > thresholds::UNEXPLAINED_FRACTION;
            let similarity = match is_new && is_distinct {
                true => pool.screening.similarity(other, response),
                false => 0.0,
            };
            let pair = vec![kept, response];
            let is_known = |fitted: &FittedHypothesis| {
                fitted.responses.len() == 2 && pair.iter().all(|r| fitted.responses.contains(r))
            };
            let is_same = pool.candidate(response).effect == pool.candidate(other).effect;
            let may_be = similarity > thresholds::INDISTINGUISHABLE
                || (!at_floor && is_same && similarity > 0.0);
            if may_be && !fitted_hypotheses.iter().any(is_known) {
                found.push((similarity, pair));
            }
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(thresholds::FITS_AT_ONCE);
    let hypothesis = |(_, responses): (f64, Vec<ResponseId>)| Hypothesis {
        sizes: pool.screening.predicted(&responses).sizes,
        responses,
        deleted: None,
    };
    let hypotheses = found.into_iter().map(hypothesis).collect();
    let mut fitted_hypotheses = full_fits(pool, preliminary_fits(pool, hypotheses));
    let alone = halves_alone(pool, &fitted_hypotheses);
    fitted_hypotheses.extend(alone);
    fitted_hypotheses
}
