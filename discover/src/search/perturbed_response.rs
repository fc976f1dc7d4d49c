//! Responses of candidates by simulation of their models. The size of each candidate is chosen so
//! that the outputs change by a fraction of the misfit. The method applies to every candidate.

use crate::ids::WindowId;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::catalogue::candidate::{Candidate, CandidateParameter};
use crate::catalogue::candidate_unknown::CandidateUnknown;
use crate::error::DiscoverError;
use crate::fit::fit_result::Fit;
use crate::fit::gauss_newton::Estimate;
use crate::fit::linearised_fit::LinearisedFit;
use crate::fit::sensitivity::SensitivityEvaluator;
use crate::fit::shooting::Shooting;
use crate::fit::variable_projection::StateProjection;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::Unknown;
use crate::search::response::CandidateResponse;
use crate::thresholds;

/// Computes the responses of all candidates. Candidates that differ only in the order share one
/// size search.
pub fn simulate_responses(
    at: &LinearisedFit,
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    candidates: &[Candidate],
) -> Vec<Result<CandidateResponse, DiscoverError>> {
    let similar = |a: &Candidate, b: &Candidate| {
        let angle = |c: &Candidate| c.angle_order.as_ref().map(|(angle, _)| angle.clone());
        a.effect == b.effect && a.site == b.site && a.load == b.load && angle(a) == angle(b)
    };
    let groups: Vec<&[Candidate]> = candidates.chunk_by(similar).collect();
    let found: Vec<Vec<Result<CandidateResponse, DiscoverError>>> = groups
        .par_iter()
        .map(|group| {
            let mut sizes: Vec<f64> = Vec::new();
            let of_group = group.iter().map(|candidate| {
                let found = simulate_response(at, problem, fit, candidate, &sizes);
                if let Ok(CandidateResponse {
                    candidate_unknowns, ..
                }) = &found
                {
                    sizes = candidate_unknowns
                        .iter()
                        .map(|candidate_unknown| candidate_unknown.unknown.scale)
                        .collect();
                }
                found
            });
            of_group.collect()
        })
        .collect();
    found.into_iter().flatten().collect()
}

/// Returns the response of a candidate in each window, one column per scaling parameter.
fn simulate_response(
    at: &LinearisedFit,
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    candidate: &Candidate,
    sizes: &[f64],
) -> Result<CandidateResponse, DiscoverError> {
    let LinearisedFit {
        windows,
        projections: base,
        level,
        estimate,
        fraction: part,
    } = at;
    let start: Vec<f64> = candidate
        .parameters
        .iter()
        .map(CandidateParameter::neutral_value)
        .collect();
    let texts = candidate.add_to_texts(problem, &fit.texts, &start)?;
    let model = problem.compile_model(&texts.full, Some(&texts.linear))?;
    let mut candidate_unknowns: Vec<CandidateUnknown> = candidate
        .parameters
        .iter()
        .map(CandidateUnknown::from_parameter)
        .collect();
    for (candidate_unknown, size) in candidate_unknowns.iter_mut().zip(sizes) {
        candidate_unknown.unknown.scale = *size;
    }
    let extended: Vec<Unknown> = fit
        .unknowns
        .iter()
        .cloned()
        .chain(candidate_unknowns.iter().map(|t| t.unknown.clone()))
        .collect();
    let ranges = fit.map_state(&model, &fit.ranges);
    let whole = Shooting::new(problem, &model, &problem.train, &extended, &ranges);
    let shooting = Shooting {
        fraction: *part,
        ..whole
    };
    let nuisances = fit.unknowns.len();
    let mut columns = vec![Vec::new(); windows.len()];
    for number in 0..candidate_unknowns.len() {
        if candidate_unknowns[number].is_shape {
            continue;
        }
        let theta = |size: f64| {
            let mut theta = estimate.theta.clone();
            theta.extend(
                candidate_unknowns
                    .iter()
                    .map(|candidate_unknown| candidate_unknown.unknown.start),
            );
            theta[nuisances + number] = candidate_unknowns[number].base + size;
            theta
        };
        // The size is determined on the first, the middle and the last window, or on all windows if
        // these do not show the effect.
        let few = vec![0, windows.len() / 2, windows.len() - 1];
        let all = (0..windows.len()).collect();
        let is_known = number < sizes.len() || candidate_unknowns[number].base != 0.0;
        let scale = candidate_unknowns[number].unknown.scale;
        let find_size = |indices: Vec<usize>| {
            find_trial_size((scale, is_known), *level, |size| {
                let changes = compute_changes(
                    &shooting,
                    fit,
                    estimate,
                    &theta(size),
                    indices.iter().map(|k| (windows[*k], &base[*k])),
                )?;
                let numbers: f64 = changes.iter().map(|c| c.len() as f64).sum();
                let square: f64 = changes.iter().map(DVector::norm_squared).sum();
                Some((square / numbers).sqrt())
            })
        };
        let size = find_size(few).or_else(|| find_size(all));
        let Some(size) = size else {
            return Err(DiscoverError::NotExcited);
        };
        let pairs = windows.iter().copied().zip(base.iter());
        let changes = compute_changes(&shooting, fit, estimate, &theta(size), pairs)
            .ok_or(DiscoverError::CandidateSimulationFailed)?;
        for (window, change) in columns.iter_mut().zip(changes) {
            window.push(change / size);
        }
        candidate_unknowns[number].unknown.scale = size;
    }
    let blocks = columns.iter().map(|columns| {
        let rows = columns.first().map_or(0, |c: &DVector<f64>| c.len());
        DMatrix::from_fn(rows, columns.len(), |r, c| columns[c][r])
    });
    Ok(CandidateResponse {
        candidate_unknowns,
        window_columns: blocks.collect(),
    })
}

/// Returns the changes of the residuals in some windows; `None` if a motion cannot be simulated.
fn compute_changes<'b>(
    shooting: &Shooting<'_>,
    fit: &Fit,
    estimate: &Estimate,
    theta: &[f64],
    windows: impl Iterator<Item = (WindowId, &'b Option<StateProjection>)>,
) -> Option<Vec<DVector<f64>>> {
    let mut sensitivities = SensitivityEvaluator::with_fixed_unknowns(shooting, theta, 1.0)?;
    let mut changes = Vec::new();
    for (window, base) in windows {
        let Some(base) = base else {
            changes.push(DVector::zeros(0));
            continue;
        };
        let start = fit.map_state(shooting.model, &estimate.initial_states[window]);
        let residual = sensitivities.compute_residual(window, &start)?;
        changes.push(DVector::from_vec(residual.values) - &base.residual);
    }
    Some(changes)
}

/// Returns the size of a parameter for which the outputs change by the required amount; `None` if
/// there is no such size. `start`: first trial size, and true if it was derived from the model. In
/// this case it may be returned without a correction, because it does not depend on units.
fn find_trial_size(
    (start, is_known): (f64, bool),
    level: f64,
    moved: impl Fn(f64) -> Option<f64>,
) -> Option<f64> {
    let wanted = thresholds::RESPONSE_OUTPUT_CHANGE * level;
    let near = thresholds::RESPONSE_CHANGE_FACTORS.scale(wanted);
    let mut size = start;
    let mut corrections = 0;
    for _ in 0..thresholds::MAX_SIZE_ATTEMPTS {
        let factor = match moved(size) {
            Some(change) if near.contains(change) => {
                let factor = wanted / change;
                let is_same = thresholds::SAME_SIZE_FACTORS.contains(factor);
                if is_known || is_same || corrections == thresholds::MAX_SIZE_CORRECTIONS {
                    return Some(size);
                }
                corrections += 1;
                factor
            }
            Some(change) if change.is_finite() && change > 0.0 => wanted / change,
            Some(_) => thresholds::MAX_SIZE_FACTOR,
            None => 1e-3,
        };
        size *= factor.clamp(
            1.0 / thresholds::MAX_SIZE_FACTOR,
            thresholds::MAX_SIZE_FACTOR,
        );
    }
    None
}
