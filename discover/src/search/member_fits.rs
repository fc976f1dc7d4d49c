//! Fits of the members of the classes, each in place of the accepted effect. They give the sizes of
//! the members, and the sizes of the other effects with these members.

use crate::catalogue::candidate::Candidate;
use crate::fit::fit_result::Fit;
use crate::ids::{EffectId, ResponseId, UnknownId};
use crate::search::backward_elimination::fit_without_effect;
use crate::search::context::RoundContext;
use crate::search::hypothesis::Hypothesis;
use crate::search::hypothesis_fits::{FittedHypothesis, run_full_fits, run_preliminary_fits};
use crate::search::pool::CandidatePool;
use crate::search::screening::screen_candidates;
use crate::search::search_result::SearchResult;
use crate::thresholds;

/// Candidate that is inseparable from an accepted effect, with the fit in which it replaces this
/// effect.
pub struct MemberFit {
    /// The candidate.
    pub candidate: Candidate,
    /// The fit and the unknowns of the candidate in it; `None` if the fit failed.
    pub fitted: Option<(Fit, Vec<UnknownId>)>,
}

/// Fits the members of the class of each accepted effect. `context`: context of the search.
pub fn fit_members(context: RoundContext<'_>, found: &SearchResult) -> Vec<Vec<MemberFit>> {
    let effects = EffectId::first(found.accepted.len());
    effects
        .map(
            |effect| match found.accepted[effect].equivalents.is_empty() {
                true => Vec::new(),
                false => fit_members_of_class(context, found, effect),
            },
        )
        .collect()
}

/// For each candidate that is inseparable from an accepted effect, fits the model with the
/// candidate in place of this effect. Other accepted effects stay in the model.
fn fit_members_of_class(
    context: RoundContext<'_>,
    found: &SearchResult,
    effect: EffectId,
) -> Vec<MemberFit> {
    let accepted = &found.accepted[effect];
    (context.progress)(&format!(
        "fitting {} effects in place of {}",
        accepted.equivalents.len(),
        accepted.candidate.label()
    ));
    let without_effect = match found.accepted.len() {
        1 => None,
        _ => fit_without_effect(context.problem, found, effect).ok(),
    };
    let mut fitted_hypotheses = match (&without_effect, found.accepted.len()) {
        (Some(fit), _) => fit_candidates(RoundContext { fit, ..context }, &accepted.equivalents),
        (None, 1) => fit_candidates(context, &accepted.equivalents),
        (None, _) => Vec::new(),
    };
    let members = accepted.equivalents.iter();
    members
        .map(|candidate| {
            let label = candidate.label();
            let index = fitted_hypotheses.iter().position(|(own, _)| *own == label);
            let fitted = index.map(|index| {
                let (_, fitted) = fitted_hypotheses.swap_remove(index);
                let unknowns = fitted.effect_unknowns.iter().map(|own| own.unknown);
                let unknowns = unknowns.collect();
                (fitted.fit, unknowns)
            });
            MemberFit {
                candidate: candidate.clone(),
                fitted,
            }
        })
        .collect()
}

/// Fits the model with each candidate, and returns the fits that succeeded with their labels.
fn fit_candidates(
    context: RoundContext<'_>,
    candidates: &[Candidate],
) -> Vec<(String, FittedHypothesis)> {
    let is_whole = context.starts_with_whole_windows();
    let part = match is_whole {
        true => 1.0,
        false => thresholds::PRELIMINARY_FRACTION,
    };
    let screening = screen_candidates(context.problem, context.fit, candidates, part);
    let pool = CandidatePool::new(context, candidates, &screening, is_whole);
    let responses = ResponseId::first(screening.responses.len());
    let hypotheses = responses.map(|response| Hypothesis {
        predicted_sizes: screening.responses[response].sizes.clone(),
        responses: vec![response],
        replaced_parameter: None,
    });
    let fitted = run_full_fits(&pool, run_preliminary_fits(&pool, hypotheses.collect()));
    fitted
        .into_iter()
        .map(|fitted| (pool.label(&fitted.responses), fitted))
        .collect()
}
