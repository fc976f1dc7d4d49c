//! Candidates for shifted parameters without a declared uncertainty. They are tried if no other
//! effect is accepted, and compared with accepted effects that have a similar response, as are
//! waves over an angle.

use eomgen_compiled_model::TypicalSizes;

use crate::catalogue::candidate::{self, Candidate, candidates};
use crate::catalogue::input_faults::input_faults;
use crate::catalogue::sites::sites;
use crate::catalogue::usual_motion::UsualMotion;
use crate::ids::{CandidateId, ResponseId};
use crate::model::unknowns::{Unknown, What};
use crate::search::context::Context;
use crate::search::dropped_priors::dropped_prior;
use crate::search::motion_of_fit::motion_of;
use crate::search::pool::Pool;
use crate::search::screening::{ScreenedResponse, screening};
use crate::search::singles::similar;
use crate::search::tested::TestedPool;
use crate::thresholds;

/// Parameters and waves with a response similar to that of the named effect.
pub struct SimilarOffsets {
    /// Screened candidates, the named effect among them, and the fits of the similar candidates.
    pub tested: TestedPool,
    /// Response of the named effect.
    pub selected: ResponseId,
}

/// Returns the candidates for shifted parameters that are not unknowns, for errors of inputs, and
/// for effects equivalent to a shifted stiffness.
pub fn offsets(context: Context<'_>) -> Vec<Candidate> {
    let (fit, path) = (context.fit, &context.problem.path);
    let is_known = |name: &str| {
        let of = |unknown: &Unknown| match &unknown.what {
            What::Parameter(known) | What::Inverse(known) => known == name,
            What::Gain(_) | What::Bias(_) | What::Delay(_) | What::InputDelay => false,
        };
        fit.unknowns.iter().any(of)
    };
    let parameters = fit.model.specification().parameters.iter();
    let free = parameters.filter(|parameter| !is_known(&parameter.name));
    let parameters = free.filter_map(candidate::offset_of);
    let model = fit.model.specification();
    let scaling = (context.effects.iter()).filter(|effect| effect.scales_stiffness());
    parameters
        .chain(input_faults(model, path))
        .chain(candidates(
            model,
            scaling,
            &sites(model),
            &UsualMotion {
                sizes: TypicalSizes::new(model, fit.model.orders()),
                ..UsualMotion::default()
            },
        ))
        .collect()
}

/// Fits parameters and waves over the angle of the named effect that have a similar response in its
/// place and keeps those that explain the records. If the named effect is a shifted parameter,
/// similar sensors and declared parameters are fitted too: a sensor gain and a model parameter may
/// be equivalent. `None` if no candidate is similar. The fit of the context is the one before the
/// effect was named.
pub fn similar_offsets(context: Context<'_>, selected: &Candidate) -> Option<SimilarOffsets> {
    let offsets = offsets(context);
    let (offsets, called) = match offsets.iter().any(|offset| offset.is_same_as(selected)) {
        true => (
            dropped_prior(context.problem, context.fit),
            "sensors and declared parameters",
        ),
        false => (
            [offsets, waves(context, selected)].concat(),
            "parameters of the model and of inputs",
        ),
    };
    if offsets.is_empty() {
        return None;
    }
    (context.progress)(&format!(
        "screening {} {called} similar to {}",
        offsets.len(),
        selected.label()
    ));
    let is_whole = context.is_whole();
    let part = if is_whole {
        1.0
    } else {
        thresholds::FIRST_PART
    };
    let candidates: Vec<Candidate> = std::iter::once(selected.clone()).chain(offsets).collect();
    let screening = screening(context.problem, context.fit, &candidates, part);
    let is_selected = |r: &ScreenedResponse| r.candidate == CandidateId::new(0);
    let own = screening.responses.iter().position(is_selected)?;
    let own = ResponseId::new(own);
    let pool = Pool::new(context, &candidates, &screening, is_whole);
    let mut fitted_hypotheses = similar(&pool, own);
    fitted_hypotheses.retain(|fitted| fitted.explains);
    let tested = TestedPool {
        candidates,
        screening,
        fitted_hypotheses,
    };
    Some(SimilarOffsets {
        tested,
        selected: own,
    })
}

/// What repeats with the angle on which something was named that does not: an unbalanced weight and a torque
/// that repeats once per turn are one term. A round looks at them only where all else promises little.
fn waves(context: Context<'_>, selected: &Candidate) -> Vec<Candidate> {
    if selected.order.is_some() {
        return Vec::new();
    }
    let (problem, fit) = (context.problem, context.fit);
    let model = fit.model.specification();
    let sites = sites(model);
    let motion = motion_of(problem, fit, &sites);
    let mut waves = candidates(model, context.effects, &sites, &motion);
    waves.retain(|wave| wave.order.is_some() && wave.on == selected.on);
    waves
}
