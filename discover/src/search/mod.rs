//! Search for missing effects: screening, full fits of the best candidates, acceptance or
//! rejection, repeated until the noise floor is reached or no effect is accepted.
//!
//! The files in the order of their dependence: [`response`] by [`mod@variational_response`] or
//! [`mod@perturbed_response`] (selected in [`mod@responses`]), [`screening`], [`acceptance`],
//! [`split_sample`]; `motion_of_fit`, [`context`], [`pool`], [`hypothesis`], [`fitted`];
//! `shape_restarts`, `singles`, `halves_alone`, `pairs`; [`tested`], [`parameter_offsets`],
//! [`selected`], `alternatives`; `excitation_window`, `dropped_priors`, `round`, `answer`,
//! `unfinished`, [`mod@unconfirmed`]; [`found`], `rejected`, [`backward_elimination`].

pub mod acceptance;
mod alternatives;
mod answer;
pub mod backward_elimination;
pub mod context;
mod dropped_priors;
mod excitation_window;
pub mod fitted;
pub mod found;
mod halves_alone;
pub mod hypothesis;
mod motion_of_fit;
mod pairs;
pub mod parameter_offsets;
pub mod perturbed_response;
pub mod pool;
mod rejected;
pub mod rejection;
pub mod response;
pub mod responses;
mod round;
pub mod screening;
pub mod selected;
mod shape_restarts;
mod singles;
pub mod split_sample;
pub mod tested;
pub mod unconfirmed;
mod unfinished;
pub mod variational_response;

use crate::catalogue::effect::Effect;
use crate::error::DiscoverError;
use crate::fit::fitted::Fit;
use crate::ids::EffectId;
use crate::model::problem::EstimationProblem;
use crate::search::acceptance::test_statistics;
use crate::search::answer::answer;
use crate::search::backward_elimination::eliminate_backwards;
use crate::search::context::Context;
use crate::search::found::{Accepted, Found, TestGap};
use crate::search::rejected::note_rejected;
use crate::search::round::Round;
use crate::search::selected::Selected;
use crate::search::unconfirmed::unconfirmed;
use crate::search::unfinished::unfinished;
use crate::thresholds;

/// Searches for the missing effects of a model. `floor`: noise floor, in standard deviations.
/// `progress`: receiver of progress lines.
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
) -> Result<Found, DiscoverError> {
    let mut found = Found {
        null,
        last: None,
        accepted: Vec::new(),
        rejected: Vec::new(),
        unconfirmed: None,
        unfinished: None,
    };
    while found.accepted.len() < thresholds::MOST_EFFECTS {
        let fit = found.last.as_ref().unwrap_or(&found.null);
        if fit.is_at_floor(floor) {
            break;
        }
        let (number, most) = (found.accepted.len() + 1, thresholds::MOST_EFFECTS);
        progress(&format!(
            "effect {number} of at most {most}: the residual is {:.1} standard deviations, the noise floor \
             {floor:.1}",
            fit.rms()
        ));
        let round = Round {
            context: Context {
                problem,
                fit,
                floor,
                effects,
                progress,
            },
            is_first: found.accepted.is_empty(),
        };
        let mut tested = round.round();
        let so_far = unfinished(&tested);
        if problem.stop.is_late() {
            found.unfinished = Some(so_far);
            break;
        }
        problem.stop.check()?;
        note_rejected(&mut found.rejected, &tested);
        let unconfirmed = unconfirmed(&mut tested, fit);
        let selected = answer(&round, tested);
        if problem.stop.is_late() {
            found.unfinished = Some(so_far);
            break;
        }
        let Some(selected) = selected else {
            found.unconfirmed = unconfirmed;
            break;
        };
        accept(&mut found, selected);
        eliminate_backwards(problem, &mut found, progress);
    }
    problem.stop.lift();
    problem.stop.check()?;
    Ok(found)
}

/// Takes what is named over, with the candidates that are indistinguishable from it.
fn accept(found: &mut Found, selected: Selected) {
    let (before, best) = (found.best(), selected.fitted);
    let gap = TestGap {
        before: before.test.rms,
        after: best.fit.test.rms,
    };
    let statistics = best
        .verdict
        .unwrap_or_else(|_| test_statistics(before, &best.fit, &best.own));
    let effects = EffectId::first(selected.candidates.len());
    let accepted = effects.zip(selected.candidates).map(|(effect, candidate)| {
        let own = best.own.iter().filter(|own| own.effect == effect);
        Accepted {
            candidate,
            unknowns: own.map(|own| own.unknown).collect(),
            equivalent: selected.equivalent[effect].clone(),
            statistics: statistics.clone(),
            test_gap: match selected.half {
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
    let mut accepted: Vec<Accepted> = accepted.collect();
    if selected.half.is_some_and(|half| half.effect.index() != 0) {
        accepted.reverse();
    }
    found.accepted.extend(accepted);
    found.last = Some(best.fit);
}
