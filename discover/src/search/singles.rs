//! Hypotheses of one candidate: those with the best prediction, and those similar to another.

use crate::fit::preliminary::PreliminaryFit;
use crate::ids::{CandidateId, ResponseId};
use crate::search::fitted::{FittedHypothesis, full_fits, preliminary_fits};
use crate::search::hypothesis::Hypothesis;
use crate::search::pool::Pool;
use crate::search::shape_restarts::reshape;
use crate::thresholds;

/// Fits the best single candidates from index `from` on, and those similar to them.
pub fn singles(pool: &Pool<'_>, from: CandidateId) -> Vec<FittedHypothesis> {
    let mut ranking = pool.ranking();
    ranking.retain(|response| pool.screening.responses[*response].candidate >= from);
    if let Some(best) = ranking.first() {
        let (count, best) = (ranking.len(), pool.candidate(*best).label());
        (pool.context.progress)(&format!("{count} candidates worth fitting; best: {best}"));
    }
    let mut preliminaries = preliminary_fits(pool, chosen(pool, &ranking));
    if !pool
        .context
        .fit
        .leaves_less(thresholds::CLOSE * pool.context.floor)
    {
        let most = thresholds::HELPS * pool.screening.predicted(&[]).cost;
        preliminaries.retain(|(_, preliminary)| preliminary.cost < most);
    }
    let mut fitted_hypotheses: Vec<FittedHypothesis> = Vec::new();
    let (mut fits, mut best) = (0, f64::INFINITY);
    while !preliminaries.is_empty() && fits < thresholds::MOST_FITS {
        // Once one is accepted, only what is nearly as good or looks like it may be another
        // answer; until then whoever is next.
        let accepted = fitted_hypotheses
            .iter()
            .find(|fitted| fitted.verdict.is_ok());
        if accepted.is_none() {
            best = preliminaries[0].1.cost;
        }
        let count = preliminaries.len().min(thresholds::FITS_AT_ONCE);
        let next: Vec<(Hypothesis, PreliminaryFit)> = preliminaries.drain(..count).collect();
        let is_rival = |(hypothesis, preliminary): &(Hypothesis, PreliminaryFit)| {
            let near = preliminary.cost < thresholds::RIVAL * best;
            match accepted {
                Some(fitted) => {
                    let similar = pool
                        .screening
                        .similarity(fitted.responses[0], hypothesis.responses[0]);
                    similar > thresholds::INDISTINGUISHABLE
                        || (near && !fitted.fit.is_at_floor(pool.context.floor))
                }
                None => near,
            }
        };
        let wanted: Vec<(Hypothesis, PreliminaryFit)> = next.into_iter().filter(is_rival).collect();
        fits += wanted.len();
        fitted_hypotheses.extend(full_fits(pool, wanted));
    }
    reshape(pool, &mut fitted_hypotheses);
    fitted_hypotheses
}

/// Fits candidates similar to one of them with a sufficient prediction, the most similar first; at
/// most [`thresholds::MOST_FITS`].
pub fn similar(pool: &Pool<'_>, response: ResponseId) -> Vec<FittedHypothesis> {
    let similarity = |other: &ResponseId| pool.screening.similarity(response, *other);
    let mut similar = pool.ranking();
    similar.retain(|other| *other != response && similarity(other) > thresholds::INDISTINGUISHABLE);
    similar.sort_by(|a, b| similarity(b).total_cmp(&similarity(a)));
    similar.truncate(thresholds::MOST_FITS);
    full_fits(pool, preliminary_fits(pool, chosen(pool, &similar)))
}

/// Those of the ranked that get a preliminary fit: of what repeats with an angle, of which there is so
/// much that some is lucky, half as many, and of the orders of one effect at one place the
/// two best.
fn chosen(pool: &Pool<'_>, ranking: &[ResponseId]) -> Vec<Hypothesis> {
    let (mut plain, mut repeating) = (Vec::new(), Vec::new());
    for response in ranking {
        let of = pool.candidate(*response);
        let is_same = |known: &&ResponseId| {
            let known = pool.candidate(**known);
            known.effect == of.effect && known.on == of.on
        };
        if of.order.is_none() && plain.len() < pool.most {
            plain.push(*response);
        } else if of.order.is_some()
            && repeating.len() < pool.most.div_ceil(2)
            && repeating.iter().filter(is_same).count() < 2
        {
            repeating.push(*response);
        }
    }
    let both = plain.into_iter().chain(repeating);
    both.map(|response| Hypothesis {
        sizes: pool.screening.responses[response].values.clone(),
        responses: vec![response],
        deleted: None,
    })
    .collect()
}
