//! Candidates for shifts of undeclared parameters. They are tried if no other effect is accepted.
//! Together with waves over an angle, they are also compared with accepted effects of similar
//! response.

use eomgen_compiled_model::TypicalSizes;

use crate::catalogue::candidate::{self, Candidate, list_candidates};
use crate::catalogue::input_faults::list_input_faults;
use crate::catalogue::sites::find_sites;
use crate::catalogue::usual_motion::UsualMotion;
use crate::ids::{CandidateId, ResponseId};
use crate::model::unknowns::{Unknown, UnknownKind};
use crate::search::context::RoundContext;
use crate::search::dropped_priors::list_prior_candidates;
use crate::search::motion_of_fit::compute_usual_motion;
use crate::search::pairs::fit_replacements;
use crate::search::pool::CandidatePool;
use crate::search::screening::{ScreenedResponse, screen_candidates};
use crate::search::single_candidates::fit_similar;
use crate::search::tested_pool::TestedPool;
use crate::thresholds;

/// Undeclared parameters and waves whose responses are similar to that of the named effect.
pub struct SimilarOffsets {
    /// Screened candidates, including the named effect, and the fits of the similar candidates.
    pub tested_pool: TestedPool,
    /// Responses of the named effects.
    pub selected_responses: Vec<ResponseId>,
}

/// Returns the candidates for shifts of undeclared parameters, for errors of inputs, and for
/// effects that are equivalent to a shifted stiffness.
pub fn list_offsets(context: RoundContext<'_>) -> Vec<Candidate> {
    let (fit, path) = (context.fit, &context.problem.path);
    let is_known = |name: &str| {
        let of = |unknown: &Unknown| match &unknown.kind {
            UnknownKind::Parameter(known) | UnknownKind::InverseParameter(known) => known == name,
            UnknownKind::Gain(_)
            | UnknownKind::Bias(_)
            | UnknownKind::Delay(_)
            | UnknownKind::InputDelay => false,
        };
        fit.unknowns.iter().any(of)
    };
    let parameters = fit.model.specification().parameters.iter();
    let free = parameters.filter(|parameter| !is_known(&parameter.name));
    let parameters = free.filter_map(candidate::shift_parameter);
    let model = fit.model.specification();
    let scaling = (context.effects.iter()).filter(|effect| effect.scales_stiffness());
    parameters
        .chain(list_input_faults(model, path))
        .chain(list_candidates(
            model,
            scaling,
            &find_sites(model),
            &UsualMotion {
                sizes: TypicalSizes::new(model, fit.model.orders()),
                ..UsualMotion::default()
            },
        ))
        .collect()
}

/// Fits parameters, and waves over the angle of the named effect, in place of this effect if their
/// responses are similar. Keeps those that explain the records. If the named effect is a shifted
/// parameter, similar sensors and declared parameters are fitted too: a sensor gain and a model
/// parameter may be equivalent. `None` if no candidate is similar. The context contains the fit
/// without the named effect.
pub fn fit_similar_offsets(
    context: RoundContext<'_>,
    selected: &Candidate,
) -> Option<SimilarOffsets> {
    let offsets = list_offsets(context);
    let (offsets, called) = match offsets
        .iter()
        .any(|offset| offset.is_same_effect_as(selected))
    {
        true => (
            list_prior_candidates(context.problem, context.fit),
            "sensors and declared parameters",
        ),
        false => (
            [offsets, list_waves(context, selected)].concat(),
            "parameters of the model and of inputs",
        ),
    };
    fit_similar_candidates(context, selected, (offsets, called))
}

/// Fits undeclared parameters, declared parameters, inputs and sensors in place of an accepted
/// effect. Keeps those that explain the records. `None` if no candidate is similar. The context
/// contains the fit without the effect.
pub fn fit_similar_values(
    context: RoundContext<'_>,
    accepted: &Candidate,
) -> Option<SimilarOffsets> {
    let mut values = list_offsets(context);
    values.extend(list_prior_candidates(context.problem, context.fit));
    values.retain(|value| !value.is_same_effect_as(accepted));
    fit_similar_candidates(
        context,
        accepted,
        (values, "parameters, inputs and sensors"),
    )
}

/// Screens candidates, called `called` in messages, together with the named effect, and fits those
/// whose responses are similar to that of the named effect.
fn fit_similar_candidates(
    context: RoundContext<'_>,
    selected: &Candidate,
    (offsets, called): (Vec<Candidate>, &str),
) -> Option<SimilarOffsets> {
    if offsets.is_empty() {
        return None;
    }
    (context.progress)(&format!(
        "screening {} {called} similar to {}",
        offsets.len(),
        selected.label()
    ));
    let is_whole = context.starts_with_whole_windows();
    let part = if is_whole {
        1.0
    } else {
        thresholds::PRELIMINARY_FRACTION
    };
    let candidates: Vec<Candidate> = std::iter::once(selected.clone()).chain(offsets).collect();
    let screening = screen_candidates(context.problem, context.fit, &candidates, part);
    let is_selected = |r: &ScreenedResponse| r.candidate == CandidateId::new(0);
    let own = screening.responses.iter().position(is_selected)?;
    let own = ResponseId::new(own);
    let pool = CandidatePool::new(context, &candidates, &screening, is_whole);
    let mut fitted_hypotheses = fit_similar(&pool, own);
    fitted_hypotheses.retain(|fitted| fitted.explains_records);
    let tested = TestedPool {
        candidates,
        screening,
        fitted_hypotheses,
        preliminary_outcomes: Vec::new(),
    };
    Some(SimilarOffsets {
        tested_pool: tested,
        selected_responses: vec![own],
    })
}

/// Fits pairs in which a parameter, an error of an input or a wave replaces one effect of a named
/// pair, and keeps those that explain the records. `None` if no candidate is similar. The context
/// contains the fit without the named pair.
pub fn fit_similar_pairs(
    context: RoundContext<'_>,
    halves: &[Candidate],
) -> Option<SimilarOffsets> {
    let waves = halves.iter().flat_map(|half| list_waves(context, half));
    let mut offsets: Vec<Candidate> = list_offsets(context).into_iter().chain(waves).collect();
    offsets.retain(|offset| !halves.iter().any(|half| half.is_same_effect_as(offset)));
    if offsets.is_empty() {
        return None;
    }
    let labels: Vec<String> = halves.iter().map(Candidate::label).collect();
    (context.progress)(&format!(
        "screening {} parameters of the model and of inputs instead of {}",
        offsets.len(),
        labels.join(" or ")
    ));
    let is_whole = context.starts_with_whole_windows();
    let part = match is_whole {
        true => 1.0,
        false => thresholds::PRELIMINARY_FRACTION,
    };
    let candidates = [halves, &offsets].concat();
    let screening = screen_candidates(context.problem, context.fit, &candidates, part);
    let response_of = |candidate: usize| {
        let is_own = |r: &ScreenedResponse| r.candidate == CandidateId::new(candidate);
        let place = screening.responses.iter().position(is_own)?;
        Some(ResponseId::new(place))
    };
    let own: Option<Vec<ResponseId>> = (0..halves.len()).map(response_of).collect();
    let own = own?;
    let pool = CandidatePool::new(context, &candidates, &screening, is_whole);
    let mut fitted_hypotheses = fit_replacements(&pool, &own);
    fitted_hypotheses.retain(|fitted| fitted.explains_records);
    Some(SimilarOffsets {
        tested_pool: TestedPool {
            candidates,
            screening,
            fitted_hypotheses,
            preliminary_outcomes: Vec::new(),
        },
        selected_responses: own,
    })
}

/// Returns the periodic candidates over the angle of an accepted effect that is not periodic: an
/// unbalanced weight and a torque with one period per turn are the same term. In a round, periodic
/// candidates are tested only if the predictions of all others are poor.
fn list_waves(context: RoundContext<'_>, selected: &Candidate) -> Vec<Candidate> {
    if selected.angle_order.is_some() {
        return Vec::new();
    }
    let (problem, fit) = (context.problem, context.fit);
    let model = fit.model.specification();
    let sites = find_sites(model);
    let motion = compute_usual_motion(problem, fit, &sites);
    let mut waves = list_candidates(model, context.effects, &sites, &motion);
    waves.retain(|wave| wave.angle_order.is_some() && wave.site == selected.site);
    waves
}
