//! Fits of hypotheses with one candidate: candidates with the best prediction, and candidates
//! similar to another one.

use crate::fit::preliminary_fit::PreliminaryFit;
use crate::ids::{CandidateId, ResponseId};
use crate::search::hypothesis::Hypothesis;
use crate::search::hypothesis_fits::{
    FittedHypothesis, PreliminaryFits, PreliminaryOutcome, run_full_fits, run_preliminary_fits,
    run_reported_fits,
};
use crate::search::pool::CandidatePool;
use crate::search::shape_restarts::restart_shapes;
use crate::thresholds;

/// Full and preliminary fits of single candidates.
pub struct SingleFits {
    /// Hypotheses that were fitted in full.
    pub fitted_hypotheses: Vec<FittedHypothesis>,
    /// Results of the preliminary fits.
    pub preliminary_outcomes: Vec<(ResponseId, PreliminaryOutcome)>,
}

/// Fits the best single candidates from index `from` on, and candidates similar to them.
pub fn fit_singles(pool: &CandidatePool<'_>, from: CandidateId) -> SingleFits {
    let mut ranking = pool.rank_responses();
    ranking.retain(|response| pool.screening.responses[*response].candidate >= from);
    let hypotheses = choose_hypotheses(pool, &ranking);
    if let Some(best) = ranking.first() {
        let best = pool.candidate(*best).label();
        let count = match (ranking.len(), hypotheses.len()) {
            (all, fitted) if all == fitted => format!("{all} candidates worth fitting"),
            (all, fitted) => {
                format!("{all} candidates worth fitting, the best {fitted} are fitted")
            }
        };
        (pool.context.progress)(&format!("{count}; best: {best}"));
    }
    let PreliminaryFits {
        fits: mut preliminaries,
        outcomes,
    } = run_reported_fits(pool, hypotheses);
    if !pool
        .context
        .fit
        .is_below(thresholds::MAX_FLOOR_RATIO_TO_STOP * pool.context.floor)
    {
        let most =
            thresholds::MAX_REMAINING_AFTER_PRELIMINARY_FIT * pool.screening.predict(&[]).cost;
        preliminaries.retain(|(_, preliminary)| preliminary.cost < most);
    }
    let mut fitted_hypotheses: Vec<FittedHypothesis> = Vec::new();
    let (mut fits, mut best) = (0, f64::INFINITY);
    while !preliminaries.is_empty() && fits < thresholds::MAX_FULL_FITS_PER_ROUND {
        // Until a candidate is accepted, the candidates are tested in the order of the ranking.
        // Afterwards, only similar or nearly equal candidates are tested.
        let accepted = fitted_hypotheses
            .iter()
            .find(|fitted| fitted.verdict.is_ok());
        if accepted.is_none() {
            best = preliminaries[0].1.cost;
        }
        let count = preliminaries.len().min(thresholds::PARALLEL_FIT_COUNT);
        let next: Vec<(Hypothesis, PreliminaryFit)> = preliminaries.drain(..count).collect();
        let is_rival = |(hypothesis, preliminary): &(Hypothesis, PreliminaryFit)| {
            let near = preliminary.cost < thresholds::MAX_RIVAL_COST_RATIO * best;
            match accepted {
                Some(fitted) => {
                    let similar = pool
                        .screening
                        .compute_similarity(fitted.responses[0], hypothesis.responses[0]);
                    similar > thresholds::MIN_SIMILARITY_OF_RIVALS
                        || (near && !fitted.fit.is_at_floor(pool.context.floor))
                }
                None => near,
            }
        };
        let wanted: Vec<(Hypothesis, PreliminaryFit)> = next.into_iter().filter(is_rival).collect();
        fits += wanted.len();
        fitted_hypotheses.extend(run_full_fits(pool, wanted));
    }
    restart_shapes(pool, &mut fitted_hypotheses);
    let outcomes = outcomes.into_iter();
    SingleFits {
        fitted_hypotheses,
        preliminary_outcomes: outcomes
            .map(|(responses, outcome)| (responses[0], outcome))
            .collect(),
    }
}

/// Fits candidates with a sufficient predicted improvement that are similar to a given one. At most
/// [`thresholds::MAX_FULL_FITS_PER_ROUND`] are fitted, the most similar first. Less similar
/// candidates are fitted only if their preliminary fit is as good.
pub fn fit_similar(pool: &CandidatePool<'_>, response: ResponseId) -> Vec<FittedHypothesis> {
    let similarity = |other: &ResponseId| pool.screening.compute_similarity(response, *other);
    let is_rival = |other: &ResponseId| similarity(other) > thresholds::MIN_SIMILARITY_OF_RIVALS;
    let mut similar = pool.rank_responses();
    similar.retain(|other| {
        let is_plain = pool.candidate(*other).angle_order.is_none();
        let is_fitted = is_plain && similarity(other) > thresholds::MIN_SIMILARITY_TO_FIT;
        *other != response && (is_rival(other) || is_fitted)
    });
    similar.sort_by(|a, b| similarity(b).total_cmp(&similarity(a)));
    similar.truncate(thresholds::MAX_FULL_FITS_PER_ROUND);
    let are_rivals = similar.iter().all(is_rival);
    let own = (!are_rivals).then_some(response);
    let hypotheses = choose_hypotheses(pool, &similar.into_iter().chain(own).collect::<Vec<_>>());
    let mut preliminaries = run_preliminary_fits(pool, hypotheses);
    let fitted = preliminaries
        .iter()
        .find(|(hypothesis, _)| hypothesis.responses[0] == response);
    let most = thresholds::MAX_RIVAL_COST_RATIO * fitted.map_or(0.0, |(_, own)| own.cost);
    preliminaries.retain(|(hypothesis, preliminary)| {
        let other = &hypothesis.responses[0];
        *other != response && (is_rival(other) || preliminary.cost < most)
    });
    run_full_fits(pool, preliminaries)
}

/// Selects the candidates for a preliminary fit. Periodic candidates are so numerous that some fit
/// by chance: half as many are selected, and at most two orders of one effect at one site.
fn choose_hypotheses(pool: &CandidatePool<'_>, ranking: &[ResponseId]) -> Vec<Hypothesis> {
    let (mut plain, mut repeating) = (Vec::new(), Vec::new());
    for response in ranking {
        let of = pool.candidate(*response);
        let is_same = |known: &&ResponseId| {
            let known = pool.candidate(**known);
            known.effect == of.effect && known.site == of.site
        };
        if of.angle_order.is_none() && plain.len() < pool.max_preliminary_fits {
            plain.push(*response);
        } else if of.angle_order.is_some()
            && repeating.len() < pool.max_preliminary_fits.div_ceil(2)
            && repeating.iter().filter(is_same).count() < 2
        {
            repeating.push(*response);
        }
    }
    let both = plain.into_iter().chain(repeating);
    both.map(|response| Hypothesis {
        predicted_sizes: pool.screening.responses[response].sizes.clone(),
        responses: vec![response],
        replaced_parameter: None,
    })
    .collect()
}
