//! Two effects of which neither is accepted alone, and which no pair promised: the best single one,
//! and what is accepted beside it.

use crate::ids::EffectId;
use crate::search::acceptance::{EffectUnknown, acceptance_test, is_held};
use crate::search::context::Context;
use crate::search::excitation_window::ExcitationWindow;
use crate::search::fitted::FittedHypothesis;
use crate::search::round::Round;
use crate::search::selected::{Selected, selected};
use crate::search::split_sample::SplitSample;
use crate::search::tested::TestedPool;

/// What is accepted together of what was tested, if it explains most of the residual.
pub fn joint_acceptance(round: &Round<'_>, tested: &[TestedPool]) -> Option<Selected> {
    let all = tested.iter().flat_map(|tested| {
        let with = move |fitted| (tested, fitted);
        tested.fitted_hypotheses.iter().map(with)
    });
    let promising = all.filter(|(_, fitted)| is_promising(round, fitted));
    let (tested, first) = promising.min_by(|a, b| a.1.fit.rms().total_cmp(&b.1.fit.rms()))?;
    let response = &tested.screening.responses[first.responses[0]];
    let candidate = tested.candidates[response.candidate].clone();
    (round.context.progress)(&format!("looking at what is beside {}", candidate.label()));
    let with_first = Round {
        context: Context {
            fit: &first.fit,
            ..round.context
        },
        is_first: false,
        effects: round.effects,
    };
    let mut tested = with_first.tested_in(ExcitationWindow::Whole)?;
    tested.fitted_hypotheses.retain(|fitted| fitted.explains);
    let mut found = selected(with_first.context, tested)?;
    let second = found.fitted.own.into_iter().map(|own| EffectUnknown {
        effect: EffectId::new(own.effect.index() + 1),
        ..own
    });
    found.fitted.own = first.own.iter().cloned().chain(second).collect();
    found.fitted.verdict = acceptance_test(round.context.fit, &found.fitted.fit, &found.fitted.own);
    if let Ok(statistics) = &mut found.fitted.verdict {
        let held_out = SplitSample::of(round.context.problem, round.context.fit);
        statistics.p_value =
            held_out.and_then(|of| of.p_value(&found.fitted.fit, &found.fitted.own));
    }
    let is_accepted =
        found.fitted.verdict.is_ok() && round.context.explains_most(&found.fitted.fit);
    found.candidates.insert(0, candidate);
    found.equivalent.insert(0, Vec::new());
    is_accepted.then_some(found)
}

/// Whether a single effect leaves clearly less though it is not accepted, and was not held.
fn is_promising(round: &Round<'_>, fitted: &FittedHypothesis) -> bool {
    let is_free = |own: &EffectUnknown| own.prior.is_none() && !is_held(&fitted.fit, own);
    fitted.responses.len() == 1
        && fitted.own.iter().all(is_free)
        && fitted.fit.leaves_clearly_less(round.context.fit)
}
