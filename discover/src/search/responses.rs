//! First-order responses of candidates. They are computed with tangent vectors if the exponential
//! integrator is used and the candidate adds no state, otherwise by simulation of the candidate's
//! model.

use crate::catalogue::candidate::Candidate;
use crate::error::DiscoverError;
use crate::fit::fit_result::Fit;
use crate::fit::linearised_fit::LinearisedFit;
use crate::ids::CandidateId;
use crate::model::problem::EstimationProblem;
use crate::search::perturbed_response::simulate_responses;
use crate::search::response::CandidateResponse;
use crate::search::variational_response::integrate_responses;
use crate::thresholds;

/// Computes the responses of all candidates. If the motion does not show the initial shape of a
/// candidate, such as a stop beyond the travel, other shapes of the scanned range are tried. The
/// response then contains the shape with which it was computed.
pub fn compute_responses(
    at: &LinearisedFit,
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    candidates: &[Candidate],
) -> Vec<Result<CandidateResponse, DiscoverError>> {
    let mut found = compute_at_shapes(at, problem, fit, candidates);
    for factor in list_other_shapes() {
        let not_excited: Vec<(CandidateId, Candidate)> = CandidateId::first(candidates.len())
            .filter(|id| matches!(found[id.index()], Err(DiscoverError::NotExcited)))
            .filter_map(|id| Some((id, scale_shape(&candidates[id], factor)?)))
            .collect();
        let (ids, scaled): (Vec<CandidateId>, Vec<Candidate>) = not_excited.into_iter().unzip();
        let responses = compute_at_shapes(at, problem, fit, &scaled);
        for (id, response) in ids.into_iter().zip(responses) {
            if response.is_ok() {
                found[id.index()] = response;
            }
        }
    }
    found
}

/// Returns factors on the initial shape, half a decade apart over the scanned range. The factors
/// nearest to 1 are first.
fn list_other_shapes() -> Vec<f64> {
    let (low, high) = thresholds::SHAPE_SCAN_DECADES;
    let mut halves: Vec<i32> = ((2.0 * low) as i32..=(2.0 * high) as i32).collect();
    halves.retain(|half| *half != 0);
    halves.sort_by_key(|half| half.abs());
    let factors = halves
        .into_iter()
        .map(|half| 10f64.powf(0.5 * f64::from(half)));
    factors.collect()
}

/// Returns a candidate with its shape parameters multiplied by a factor; `None` if it has no shape
/// parameter.
fn scale_shape(candidate: &Candidate, factor: f64) -> Option<Candidate> {
    let mut scaled = candidate.clone();
    let shapes = scaled.parameters.iter_mut();
    let shapes = shapes.filter_map(|parameter| parameter.shape_size.as_mut());
    let count = shapes.map(|shape| *shape *= factor).count();
    (count > 0).then_some(scaled)
}

/// Computes the responses of candidates with their initial shapes.
fn compute_at_shapes(
    at: &LinearisedFit,
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    candidates: &[Candidate],
) -> Vec<Result<CandidateResponse, DiscoverError>> {
    let mut found = integrate_responses(at, problem, fit, candidates);
    let not_driven: Vec<CandidateId> = CandidateId::first(candidates.len())
        .filter(|id| found[*id].is_none())
        .collect();
    let others: Vec<Candidate> = not_driven
        .iter()
        .map(|id| candidates[*id].clone())
        .collect();
    let perturbed_responses = simulate_responses(at, problem, fit, &others);
    for (id, response) in not_driven.into_iter().zip(perturbed_responses) {
        found[id] = Some(response);
    }
    found.into_iter().flatten().collect()
}
