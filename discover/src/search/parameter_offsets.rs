//! Parameters of the model that nobody called uncertain: candidates for being off where nothing
//! else is accepted, and beside what is accepted where they look like it; and waves over an angle that
//! look like it.

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

/// Parameters and waves that look like what was named.
pub struct SimilarOffsets {
    /// What was screened, what was named among it, and the fits of those that look like it.
    pub tested: TestedPool,
    /// The response of what was named.
    pub selected: ResponseId,
}

/// The parameters of a model that no unknown moves, how its inputs may act otherwise than recorded, and
/// what does the same as a shift of a stiffness.
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

/// Parameters that look like what was named, and waves over its angle that do, fitted in its place: those that
/// explain the records; and where what was named is such a parameter itself, sensors and declared parameters
/// that look like it: a gain and a number of the model may be two names of one thing. None where nothing
/// looks like it. The context's fit is what was fitted before anything was named.
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
        "screening {} {called} beside {}",
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
