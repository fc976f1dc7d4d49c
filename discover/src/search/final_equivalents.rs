//! Equivalents of accepted offsets after the last round. Parameters that enter a model only in combinations replace each
//! other as a set: a round fits its candidates without the effects of later rounds and cannot show this.

use crate::catalogue::candidate::Candidate;
use crate::ids::{CandidateId, EffectId, ResponseId};
use crate::search::backward_elimination::fit_without_effect;
use crate::search::context::RoundContext;
use crate::search::dropped_priors::list_prior_candidates;
use crate::search::hypothesis::Hypothesis;
use crate::search::hypothesis_fits::{run_full_fits, run_preliminary_fits};
use crate::search::parameter_offsets::list_offsets;
use crate::search::pool::CandidatePool;
use crate::search::screening::screen_candidates;
use crate::search::search_result::SearchResult;
use crate::search::selection::is_inseparable;
use crate::thresholds;

/// Returns for each accepted effect the offsets that can replace it together with the other accepted effects, if it is an
/// offset. `context`: context of the search.
pub fn find_all_equivalent_offsets(
    context: RoundContext<'_>,
    found: &SearchResult,
) -> Vec<Vec<Candidate>> {
    let find = |effect: EffectId| match found.accepted[effect].candidate.is_offset() {
        true => find_equivalent_offsets(context, found, effect),
        false => Vec::new(),
    };
    match found.accepted.len() {
        0 | 1 => Vec::new(),
        count => EffectId::first(count).map(find).collect(),
    }
}

/// Returns the new equivalents of an accepted offset.
fn find_equivalent_offsets(
    context: RoundContext<'_>,
    found: &SearchResult,
    effect: EffectId,
) -> Vec<Candidate> {
    let problem = context.problem;
    let accepted = &found.accepted[effect];
    let Ok(others) = fit_without_effect(problem, found, effect) else {
        return Vec::new();
    };
    let context = RoundContext {
        fit: &others,
        ..context
    };
    let known = || {
        let accepted = found.accepted.iter().map(|accepted| &accepted.candidate);
        accepted.chain(&found.accepted[effect].equivalents)
    };
    let offsets = list_offsets(context).into_iter();
    let offsets = offsets.chain(list_prior_candidates(problem, &others));
    let offsets =
        offsets.filter(|offset| !known().any(|candidate| candidate.is_same_effect_as(offset)));
    let candidates: Vec<Candidate> = std::iter::once(accepted.candidate.clone())
        .chain(offsets)
        .collect();
    let is_whole = context.starts_with_whole_windows();
    let part = match is_whole {
        true => 1.0,
        false => thresholds::PRELIMINARY_FRACTION,
    };
    let screening = screen_candidates(problem, &others, &candidates, part);
    let responses = || ResponseId::first(screening.responses.len());
    let candidate_id = |response: ResponseId| screening.responses[response].candidate;
    let Some(own) = responses().find(|response| candidate_id(*response) == CandidateId::new(0))
    else {
        return Vec::new();
    };
    let similarity = |response: ResponseId| screening.compute_similarity(own, response);
    let similar: Vec<ResponseId> = responses()
        .filter(|response| {
            *response != own && similarity(*response) > thresholds::MIN_SIMILARITY_OF_RIVALS
        })
        .collect();
    if similar.is_empty() {
        return Vec::new();
    }
    (context.progress)(&format!(
        "fitting {} offsets in the place of {}",
        similar.len(),
        accepted.candidate.label()
    ));
    let pool = CandidatePool::new(context, &candidates, &screening, is_whole);
    let hypotheses = std::iter::once(own)
        .chain(similar)
        .map(|response| Hypothesis {
            predicted_sizes: screening.responses[response].sizes.clone(),
            responses: vec![response],
            replaced_parameter: None,
        });
    let fitted = run_full_fits(&pool, run_preliminary_fits(&pool, hypotheses.collect()));
    let Some(accepted) = fitted.iter().find(|fitted| fitted.responses == [own]) else {
        return Vec::new();
    };
    let equivalents = fitted.iter().filter(|other| {
        let response = other.responses[0];
        response != own
            && other.explains_records
            && is_inseparable(accepted, other, similarity(response))
    });
    equivalents
        .map(|fitted| candidates[candidate_id(fitted.responses[0]).index()].clone())
        .collect()
}
