//! Fits of the members of a class, each in place of the named effect.

use crate::catalogue::candidate::Candidate;
use crate::fit::fit_result::Fit;
use crate::ids::{EffectId, ResponseId};
use crate::search::backward_elimination::fit_without_effect;
use crate::search::context::RoundContext;
use crate::search::hypothesis::Hypothesis;
use crate::search::hypothesis_fits::{run_full_fits, run_preliminary_fits};
use crate::search::pool::CandidatePool;
use crate::search::screening::screen_candidates;
use crate::search::search_result::SearchResult;
use crate::thresholds;

/// For each candidate that is inseparable from an accepted effect, fits the model with the
/// candidate in place of this effect. Other accepted effects stay in the model. A failed fit is
/// `None`. `context`: context of the search.
pub fn fit_equivalents(
    context: RoundContext<'_>,
    found: &SearchResult,
    effect: EffectId,
) -> Vec<(Candidate, Option<Fit>)> {
    let equivalent = &found.accepted[effect].equivalents;
    let others = match found.accepted.len() {
        1 => None,
        _ => fit_without_effect(context.problem, found, effect).ok(),
    };
    let fit = match (&others, found.accepted.len()) {
        (Some(others), _) => others,
        (None, 1) => &found.null_fit,
        (None, _) => return equivalent.iter().map(|of| (of.clone(), None)).collect(),
    };
    let context = RoundContext { fit, ..context };
    let is_whole = context.starts_with_whole_windows();
    let part = match is_whole {
        true => 1.0,
        false => thresholds::PRELIMINARY_FRACTION,
    };
    let screening = screen_candidates(context.problem, fit, equivalent, part);
    let pool = CandidatePool::new(context, equivalent, &screening, is_whole);
    let responses = ResponseId::first(screening.responses.len());
    let hypotheses = responses.map(|response| Hypothesis {
        predicted_sizes: screening.responses[response].sizes.clone(),
        responses: vec![response],
        replaced_parameter: None,
    });
    let mut fits: Vec<(String, Fit)> = Vec::new();
    for fitted in run_full_fits(&pool, run_preliminary_fits(&pool, hypotheses.collect())) {
        fits.push((pool.label(&fitted.responses), fitted.fit));
    }
    let of = |candidate: &Candidate| {
        let label = candidate.label();
        let index = fits.iter().position(|(known, _)| *known == label)?;
        Some(fits.swap_remove(index).1)
    };
    let mut of = of;
    equivalent
        .iter()
        .map(|candidate| (candidate.clone(), of(candidate)))
        .collect()
}
