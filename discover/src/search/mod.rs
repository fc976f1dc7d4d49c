//! Search for missing effects. Candidates are screened, the best are fitted in full and accepted or
//! rejected. This repeats until the noise floor is reached or no effect is accepted.
//!
//! The files in the order of their dependence: [`response`] by [`mod@variational_response`] or
//! [`mod@perturbed_response`] (selected in [`mod@responses`]), [`screening`], [`acceptance`],
//! [`split_sample`]; `motion_of_fit`, [`context`], [`pool`], [`hypothesis`], [`hypothesis_fits`];
//! `shape_restarts`, `single_candidates`, `pair_halves`, `pairs`; [`tested_pool`],
//! [`parameter_offsets`], [`selection`], `alternatives`, `neighbouring_orders`;
//! `excitation_window`, `dropped_priors`, `round`, `answer_selection`, `unfinished_round`,
//! [`unconfirmed_hypothesis`]; [`search_result`], `rejected_candidates`, [`backward_elimination`];
//! `scanned_laws`; `joint_classes`, [`member_fits`].

pub mod acceptance;
mod alternatives;
mod answer_selection;
pub mod backward_elimination;
pub mod context;
mod dropped_priors;
mod excitation_window;
pub mod hypothesis;
pub mod hypothesis_fits;
mod joint_classes;
pub mod member_fits;
mod motion_of_fit;
mod neighbouring_orders;
mod pair_halves;
mod pairs;
pub mod parameter_offsets;
pub mod perturbed_response;
pub mod pool;
mod rejected_candidates;
pub mod rejection;
pub mod response;
pub mod responses;
mod round;
mod scanned_laws;
pub mod screening;
pub mod search_result;
pub mod selection;
mod shape_restarts;
mod single_candidates;
pub mod split_sample;
pub mod tested_pool;
pub mod unconfirmed_hypothesis;
mod unfinished_round;
pub mod variational_response;

use crate::catalogue::effect::Effect;
use crate::error::DiscoverError;
use crate::fit::fit_result::Fit;
use crate::ids::EffectId;
use crate::model::problem::EstimationProblem;
use crate::search::acceptance::compute_test_statistics;
use crate::search::answer_selection::select_answer;
use crate::search::backward_elimination::eliminate_backwards;
use crate::search::context::RoundContext;
use crate::search::hypothesis_fits::FittedHypothesis;
use crate::search::joint_classes::find_joint_members;
use crate::search::rejected_candidates::{note_rejected, note_unfitted};
use crate::search::round::SearchRound;
use crate::search::scanned_laws::{ScanResult, scan_records};
use crate::search::search_result::{AcceptedEffect, RejectedCandidate, SearchResult, TestGap};
use crate::search::selection::{SelectedHypothesis, select_hypothesis};
use crate::search::unconfirmed_hypothesis::find_unconfirmed;
use crate::search::unfinished_round::describe_unfinished;
use crate::thresholds;

/// Searches for the missing effects of a model: in rounds, each of which adds effects, and, if a
/// gap remains, by a scan of laws. `floor`: noise floor, in standard deviations. `progress`:
/// receiver of progress lines.
///
/// # Errors
///
/// A motion that cannot be simulated; [`DiscoverError::Stopped`].
pub fn search(
    problem: &EstimationProblem<'_>,
    null: Fit,
    effects: &[Effect],
    floor: f64,
    progress: &(dyn Fn(&str) + Sync),
) -> Result<SearchResult, DiscoverError> {
    let search = Search {
        problem,
        floor,
        effects,
        progress,
    };
    let mut found = SearchResult {
        null_fit: null,
        extended_fit: None,
        accepted: Vec::new(),
        rejected: Vec::new(),
        unconfirmed: None,
        curve: None,
        unfinished: None,
    };
    let is_scanned = search.select_forward(&mut found)?;
    if !is_scanned && found.unfinished.is_none() && !found.best_fit().is_at_floor(floor) {
        search.scan_laws(&mut found);
    }
    if found.unfinished.is_none() {
        let members = find_joint_members(search.context(&found.null_fit), &found);
        for (effect, members) in found.accepted.iter_mut().zip(members) {
            effect.equivalents.extend(members);
        }
    }
    problem.stop.remove_time_limit();
    problem.stop.check_not_stopped()?;
    Ok(found)
}

/// Search for the missing effects of a model.
struct Search<'s> {
    problem: &'s EstimationProblem<'s>,
    /// Noise floor, in standard deviations.
    floor: f64,
    effects: &'s [Effect],
    /// Receiver of progress lines.
    progress: &'s (dyn Fn(&str) + Sync),
}

impl Search<'_> {
    fn context<'r>(&'r self, fit: &'r Fit) -> RoundContext<'r> {
        RoundContext {
            problem: self.problem,
            fit,
            floor: self.floor,
            effects: self.effects,
            progress: self.progress,
        }
    }

    /// Accepts effects one after the other; each explains most of the residual that remains after
    /// the earlier effects. Returns true if laws were scanned.
    fn select_forward(&self, found: &mut SearchResult) -> Result<bool, DiscoverError> {
        let Self {
            problem,
            floor,
            progress,
            ..
        } = *self;
        let mut is_scanned = false;
        while found.accepted.len() < thresholds::MAX_EFFECTS {
            let fit = found.best_fit();
            if fit.is_at_floor(floor) {
                break;
            }
            let (number, most) = (found.accepted.len() + 1, thresholds::MAX_EFFECTS);
            progress(&format!(
                "effect {number} of at most {most}: the residual over all channels is {:.1} noise floors",
                fit.rms() / floor
            ));
            let is_first_round = found.accepted.is_empty();
            let round = SearchRound {
                context: self.context(fit),
                is_first_round,
            };
            let singles = round.test_single_candidates();
            // Pairs are numerous, so laws are scanned first: a single law may explain the records.
            if is_first_round && singles.lacks_effect() && !problem.stop.is_requested() {
                is_scanned = true;
                note_rejected(&mut found.rejected, &singles.tested, floor);
                self.scan_laws(found);
                if !found.accepted.is_empty() || found.unfinished.is_some() {
                    break;
                }
            }
            let fit = found.extended_fit.as_ref().unwrap_or(&found.null_fit);
            let round = SearchRound {
                context: self.context(fit),
                is_first_round,
            };
            let mut tested = round.test_pairs(singles);
            let so_far = describe_unfinished(&tested, !found.accepted.is_empty());
            if problem.stop.is_time_over() {
                found.unfinished = Some(so_far);
                break;
            }
            problem.stop.check_not_stopped()?;
            note_rejected(&mut found.rejected, &tested, floor);
            let unconfirmed = find_unconfirmed(&mut tested, fit);
            let selected = select_answer(&round, tested);
            if problem.stop.is_time_over() {
                found.unfinished = Some(so_far);
                break;
            }
            let Some(selected) = selected else {
                found.unconfirmed = unconfirmed;
                break;
            };
            add_accepted(found, selected);
            eliminate_backwards(problem, found, progress);
        }
        Ok(is_scanned)
    }

    /// Scans laws with a shape or a memory. A law replaces the accepted effects if it reaches the
    /// noise floor, also on held-out records, and its residual is clearly smaller than theirs.
    fn scan_laws(&self, found: &mut SearchResult) {
        let context = self.context(&found.null_fit);
        let scan = scan_records(context, found.best_fit());
        if self.problem.stop.is_time_over() {
            found.unfinished = Some(
                "some laws with a shape parameter or an internal state were not scanned".to_owned(),
            );
            return;
        }
        let Some(ScanResult {
            curve,
            tested,
            unfitted,
        }) = scan
        else {
            return;
        };
        found.curve = curve;
        if let Some(tested) = &tested {
            note_rejected(
                &mut found.rejected,
                std::slice::from_ref(tested),
                self.floor,
            );
        }
        note_unfitted(&mut found.rejected, unfitted);
        let Some(mut tested) = tested else {
            return;
        };
        let best = found.best_fit();
        tested
            .fitted_hypotheses
            .retain(|FittedHypothesis { fit, .. }| {
                fit.is_at_floor(self.floor) && fit.is_clearly_below(best)
            });
        let Some(selected) = select_hypothesis(context, tested) else {
            return;
        };
        for AcceptedEffect { candidate, .. } in found.accepted.drain(..) {
            (self.progress)(&format!("  {} is no longer needed", candidate.label()));
            found.rejected.push(RejectedCandidate {
                candidate,
                reason: "with a scanned law, the records are explained better without this effect"
                    .to_owned(),
                best_of_round: None,
                is_fitted: true,
                is_untestable: false,
                p_value: None,
            });
        }
        (found.extended_fit, found.unconfirmed) = (None, None);
        add_accepted(found, selected);
    }
}

/// Adds the selected effects to the result, with the candidates that are inseparable from them.
fn add_accepted(found: &mut SearchResult, selected: SelectedHypothesis) {
    let (before, best) = (found.best_fit(), selected.hypothesis);
    let gap = TestGap {
        before: before.test.rms,
        after: best.fit.test.rms,
    };
    let statistics = best
        .verdict
        .unwrap_or_else(|_| compute_test_statistics(before, &best.fit, &best.effect_unknowns));
    let effects = EffectId::first(selected.candidates.len());
    let accepted = effects.zip(selected.candidates).map(|(effect, candidate)| {
        let own = best
            .effect_unknowns
            .iter()
            .filter(|own| own.effect == effect);
        AcceptedEffect {
            candidate,
            unknowns: own.map(|own| own.unknown).collect(),
            equivalents: selected.equivalents[effect].clone(),
            statistics: statistics.clone(),
            test_gap: match selected.accepted_half {
                Some(half) if half.effect == effect => TestGap {
                    after: half.test_rms,
                    ..gap
                },
                Some(half) => TestGap {
                    before: half.test_rms,
                    ..gap
                },
                None => gap,
            },
        }
    });
    let mut accepted: Vec<AcceptedEffect> = accepted.collect();
    if selected
        .accepted_half
        .is_some_and(|half| half.effect.index() != 0)
    {
        accepted.reverse();
    }
    found.accepted.extend(accepted);
    found.extended_fit = Some(best.fit);
}
