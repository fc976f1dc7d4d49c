//! Backward elimination: removal of effects that later effects make unnecessary.

use crate::catalogue::candidate::Candidate;
use crate::error::DiscoverError;
use crate::fit::fit_result::Fit;
use crate::fit::full_fit;
use crate::fit::preliminary_fit::{self, WarmStart};
use crate::ids::{EffectId, UnknownId};
use crate::model::problem::EstimationProblem;
use crate::search::search_result::{AcceptedEffect, RejectedCandidate, SearchResult};
use crate::thresholds;

/// Removes unnecessary effects, the least important first. `progress` receives a line for each
/// removal.
pub fn eliminate_backwards(
    problem: &EstimationProblem<'_>,
    found: &mut SearchResult,
    progress: &dyn Fn(&str),
) {
    while found.accepted.len() > 1 {
        let best = found.best_fit();
        let fits = EffectId::first(found.accepted.len()).filter_map(|effect_id| {
            let fit = fit_without_effect(problem, found, effect_id).ok()?;
            problem.stop.check_not_stopped().ok()?;
            is_as_good(best, &fit).then_some((effect_id, fit))
        });
        let least = fits.min_by(|a, b| a.1.train.rms.total_cmp(&b.1.train.rms));
        let Some((effect_id, fit)) = least else {
            return;
        };
        let label = found.accepted[effect_id].candidate.label();
        progress(&format!("  {label} is no longer needed"));
        let reason = format!(
            "unnecessary after a later effect: the test residual is {:.2} standard deviations of the noise \
             without it and {:.2} with it",
            fit.test.rms,
            found.best_fit().test.rms
        );
        let candidate = renumber(&mut found.accepted, effect_id);
        found
            .rejected
            .retain(|known| known.candidate.label() != label);
        found.rejected.push(RejectedCandidate {
            candidate,
            reason,
            best_of_round: None,
            is_fitted: true,
            is_untestable: false,
            p_value: None,
        });
        found.extended_fit = Some(fit);
    }
}

/// Returns true if a fit without an effect is as good as a fit with it, by the acceptance criteria.
fn is_as_good(with: &Fit, without: &Fit) -> bool {
    let worse =
        |with: f64, without: f64| with < (1.0 - thresholds::MIN_HELD_OUT_REDUCTION) * without;
    !worse(with.train.rms, without.train.rms) && !worse(with.test.rms, without.test.rms)
}

/// Fits the model with all accepted effects except one, starting from the estimates of the previous
/// fit.
///
/// # Errors
///
/// Errors of [`full_fit::fit_specification`].
pub(crate) fn fit_without_effect(
    problem: &EstimationProblem<'_>,
    found: &SearchResult,
    effect_id: EffectId,
) -> Result<Fit, DiscoverError> {
    let fit = found.best_fit();
    let removed = &found.accepted[effect_id];
    let mut texts = found.null_fit.texts.clone();
    for (other, effect) in EffectId::first(found.accepted.len()).zip(&found.accepted) {
        if other == effect_id || effect.candidate.dropped_prior.is_some() {
            continue;
        }
        let values = fit.values_in_specification(&effect.unknowns);
        texts = effect.candidate.add_to_texts(problem, &texts, &values)?;
    }
    let mut unknowns = fit.unknowns.clone();
    let mut theta = fit.train.estimate.theta.clone();
    if removed.candidate.dropped_prior.is_some() {
        for id in &removed.unknowns {
            unknowns[*id].clone_from(&found.null_fit.unknowns[*id]);
            theta[*id] = found.null_fit.unknowns[*id].start;
        }
    } else {
        let is_kept = |id: &UnknownId| !removed.unknowns.contains(id);
        let kept: Vec<UnknownId> = UnknownId::first(unknowns.len()).filter(is_kept).collect();
        unknowns = kept.iter().map(|id| unknowns[*id].clone()).collect();
        theta = kept.iter().map(|id| theta[*id]).collect();
    }
    let warm_start = WarmStart {
        fit,
        cost: fit.train.estimate.cost,
        max_rms: thresholds::MAX_WARM_START_RATIO * fit.train.rms,
    };
    let preliminary =
        preliminary_fit::start_from_fit(problem, texts, unknowns, &[theta], warm_start)?;
    full_fit::complete_fit(problem, preliminary)
}

/// Removes an effect from the list and renumbers the unknowns of the following effects.
fn renumber(accepted: &mut Vec<AcceptedEffect>, effect_id: EffectId) -> Candidate {
    let removed = accepted.remove(effect_id.index());
    if removed.candidate.dropped_prior.is_some() {
        return removed.candidate;
    }
    for effect in accepted {
        for id in &mut effect.unknowns {
            let before = removed
                .unknowns
                .iter()
                .filter(|removed| *removed < id)
                .count();
            *id = UnknownId::new(id.index() - before);
        }
    }
    removed.candidate
}
