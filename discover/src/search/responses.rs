//! Responses of candidates to first order: by tangent vectors if the exponential integrator is used
//! and the candidate adds no state, otherwise by simulation of the candidate's own model.

use crate::catalogue::candidate::Candidate;
use crate::error::DiscoverError;
use crate::fit::fit_result::Fit;
use crate::fit::linearised_fit::LinearisedFit;
use crate::ids::CandidateId;
use crate::model::problem::EstimationProblem;
use crate::search::perturbed_response::simulate_responses;
use crate::search::response::CandidateResponse;
use crate::search::variational_response::integrate_responses;

/// Computes the responses of all candidates.
pub fn compute_responses(
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
