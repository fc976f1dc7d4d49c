//! Classes of several accepted effects. A parameter can be inseparable from an accepted effect only
//! together with the others: in a linear oscillator, the gain of the sensor is inseparable from the
//! mass if the stiffness is unknown too.

use crate::catalogue::candidate::Candidate;
use crate::ids::EffectId;
use crate::search::backward_elimination::fit_without_effect;
use crate::search::context::RoundContext;
use crate::search::parameter_offsets::{SimilarOffsets, fit_similar_values};
use crate::search::search_result::{AcceptedEffect, SearchResult};
use crate::search::selection::is_inseparable;

/// Returns, for each accepted effect, further parameters, inputs and sensors that are inseparable
/// from it with all other accepted effects in the model. `context`: context of the search.
pub fn find_joint_members(context: RoundContext<'_>, found: &SearchResult) -> Vec<Vec<Candidate>> {
    let effects = EffectId::first(found.accepted.len());
    let members = |id: EffectId| match found.accepted.len() {
        1 => Vec::new(),
        _ => find_members_of_effect(context, found, id).unwrap_or_default(),
    };
    effects.map(members).collect()
}

/// Returns further members of the class of an accepted effect; `None` if no candidate is similar or
/// a fit failed.
fn find_members_of_effect(
    context: RoundContext<'_>,
    found: &SearchResult,
    id: EffectId,
) -> Option<Vec<Candidate>> {
    context.problem.stop.check_not_stopped().ok()?;
    let AcceptedEffect {
        candidate,
        unknowns,
        equivalents,
        ..
    } = &found.accepted[id];
    let fit = &fit_without_effect(context.problem, found, id).ok()?;
    let SimilarOffsets {
        tested_pool,
        selected_responses,
    } = fit_similar_values(RoundContext { fit, ..context }, candidate)?;
    let own = (unknowns.len(), found.best_fit());
    let inseparable = tested_pool.fitted_hypotheses.iter().filter(|fitted| {
        let [response, other] = [selected_responses[0], fitted.responses[0]];
        let similarity = tested_pool.screening.compute_similarity(response, other);
        is_inseparable(own, fitted.size_and_fit(), similarity)
    });
    let members = inseparable.map(|fitted| tested_pool.candidate(fitted.responses[0]));
    let is_new = |member: &&Candidate| {
        let mut known = equivalents.iter();
        !known.any(|known| known.is_same_effect_as(member))
    };
    Some(members.filter(is_new).cloned().collect())
}
