//! Responses of candidates with tangent vectors. The accelerations of the candidate's model minus
//! those of the fitted model, along the fitted motion, drive a tangent vector. Hundreds of
//! candidates are screened in one integration.

use std::ops::Deref;
use std::sync::LazyLock;

use crate::ids::CandidateId;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::catalogue::candidate::{Candidate, CandidateParameter};
use crate::catalogue::candidate_unknown::CandidateUnknown;
use crate::error::DiscoverError;
use crate::fit::acceleration_differences::{AccelerationDifferences, PerturbedEvaluator};
use crate::fit::fit_result::Fit;
use crate::fit::linearised_fit::LinearisedFit;
use crate::fit::sensitivity::SensitivityEvaluator;
use crate::fit::shooting::Shooting;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::search::response::CandidateResponse;
use crate::thresholds;

/// Points of a motion with their accelerations, for the choice of sizes.
struct Points {
    times: Vec<f64>,
    states: Vec<Vec<f64>>,
    inputs: Vec<Vec<f64>>,
    rates: Vec<Vec<f64>>,
    /// Sum of squares of each acceleration and of the rate of each first-order state.
    squares: Vec<f64>,
}

/// Selection of the points of a motion.
#[derive(Clone, Copy)]
enum Extent {
    /// Some samples of three windows.
    Few,
    /// All samples of all windows.
    All,
}

/// Points for the choice of sizes. All points are needed for an effect that acts only in a small
/// part of the motion, such as a stop at one end of the travel.
struct TestedPoints<'p> {
    few: Points,
    all: &'p (dyn Deref<Target = Option<Points>> + Sync),
}

/// Model of a candidate, with parameter values for which it differs slightly from the fitted model.
struct PreparedCandidate {
    candidate: CandidateId,
    candidate_unknowns: Vec<CandidateUnknown>,
    model: EstimationModel,
    /// Parameter values for each scaling parameter.
    moved: Vec<MovedValues>,
}

/// Parameter values of a model with one changed parameter.
struct MovedValues {
    /// All values, SI.
    values: Vec<f64>,
    /// Change of the parameter, SI.
    size: f64,
}

/// Returns the response of each candidate or the reason why it has no influence; `None` if the
/// candidate's own model must be simulated.
pub fn integrate_responses(
    at: &LinearisedFit,
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    candidates: &[Candidate],
) -> Vec<Option<Result<CandidateResponse, DiscoverError>>> {
    let mut found: Vec<Option<Result<CandidateResponse, DiscoverError>>> =
        vec![None; candidates.len()];
    let Some(few) = sample_points(at, problem, fit, Extent::Few) else {
        return found;
    };
    let all = LazyLock::new(|| sample_points(at, problem, fit, Extent::All));
    let tested = TestedPoints { few, all: &all };
    let ids: Vec<CandidateId> = CandidateId::first(candidates.len()).collect();
    let ready: Vec<Option<Result<PreparedCandidate, DiscoverError>>> = ids
        .par_iter()
        .map(|id| prepare_candidate(problem, fit, candidates, *id, &tested))
        .collect();
    let mut all = Vec::new();
    for (id, ready) in ids.into_iter().zip(ready) {
        match ready {
            Some(Ok(ready)) => all.push(ready),
            Some(Err(reason)) => found[id] = Some(Err(reason)),
            None => {}
        }
    }
    let windows = integrate_drives(at, problem, fit, &all);
    let mut first = 0;
    for mut of in all {
        let columns = first..first + of.moved.len();
        first = columns.end;
        let blocks: Vec<DMatrix<f64>> = windows
            .iter()
            .map(|window| match window.ncols() {
                0 => DMatrix::zeros(0, columns.len()),
                _ => window.columns(columns.start, columns.len()).into_owned(),
            })
            .collect();
        found[of.candidate] = Some(scale_to_level(&mut of.candidate_unknowns, blocks, at.level));
    }
    found
}

/// Sets the scale of each parameter to the size that changes the outputs by a fraction of the
/// misfit. Returns the response of the candidate.
fn scale_to_level(
    candidate_unknowns: &mut [CandidateUnknown],
    blocks: Vec<DMatrix<f64>>,
    level: f64,
) -> Result<CandidateResponse, DiscoverError> {
    let scaling = candidate_unknowns
        .iter_mut()
        .filter(|candidate_unknown| !candidate_unknown.is_shape);
    for (column, candidate_unknown) in scaling.enumerate() {
        let numbers: usize = blocks.iter().map(DMatrix::nrows).sum();
        let square: f64 = blocks.iter().map(|b| b.column(column).norm_squared()).sum();
        let size = (square / numbers.max(1) as f64).sqrt();
        if size == 0.0 || !size.is_finite() {
            return Err(DiscoverError::NotExcited);
        }
        candidate_unknown.unknown.scale = thresholds::RESPONSE_OUTPUT_CHANGE * level / size;
    }
    Ok(CandidateResponse {
        candidate_unknowns: candidate_unknowns.to_vec(),
        window_columns: blocks,
    })
}

/// Returns points of the fitted motion; `None` if the model has no tangent vectors.
fn sample_points(
    at: &LinearisedFit,
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    extent: Extent,
) -> Option<Points> {
    let shooting = fit.training_shooting(problem);
    let LinearisedFit {
        estimate, windows, ..
    } = at;
    let values = shooting.parameter_values(&estimate.theta);
    let mut simulation = fit.model.create_simulation(&values).ok()?;
    if !simulation.has_tangents() {
        return None;
    }
    let first = fit.model.degrees_of_freedom();
    let mut points = Points {
        times: Vec::new(),
        states: Vec::new(),
        inputs: Vec::new(),
        rates: Vec::new(),
        squares: vec![0.0; fit.model.state_count() - first],
    };
    let (indices, stride) = match extent {
        Extent::Few => (
            vec![0, windows.len() / 2, windows.len() - 1],
            thresholds::SIZE_SAMPLE_STRIDE,
        ),
        Extent::All => ((0..windows.len()).collect(), 1),
    };
    for id in indices.into_iter().map(|index| windows[index]) {
        let window = &problem.train.windows[id];
        let inputs = problem.train.inputs(window);
        let Ok(states) =
            simulation.simulate_states(&estimate.initial_states[id], &window.times, inputs)
        else {
            continue;
        };
        let samples = window.times.iter().zip(states).step_by(stride);
        for (t, state) in samples {
            let inputs = inputs.evaluate(*t);
            let rates = simulation.compute_rates(*t, &state, &inputs);
            for (sum, rate) in points.squares.iter_mut().zip(&rates[first..]) {
                *sum += rate * rate;
            }
            points.times.push(*t);
            points.states.push(state);
            points.inputs.push(inputs.into_owned());
            points.rates.push(rates);
        }
    }
    (!points.times.is_empty()).then_some(points)
}

/// Derives the model of a candidate with small sizes, if it has the states and measured outputs of
/// the fit.
fn prepare_candidate(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    candidates: &[Candidate],
    id: CandidateId,
    points: &TestedPoints<'_>,
) -> Option<Result<PreparedCandidate, DiscoverError>> {
    if let Err(stopped) = problem.stop.check_not_stopped() {
        return Some(Err(stopped));
    }
    let candidate = &candidates[id];
    let start: Vec<f64> = candidate
        .parameters
        .iter()
        .map(CandidateParameter::neutral_value)
        .collect();
    let text = match candidate.write_effect(&fit.texts.full, &problem.path, &start, "") {
        Ok(text) => text,
        Err(error) => return Some(Err(error.into())),
    };
    let channels = &problem.dataset.channels;
    let model =
        match EstimationModel::derive_equations(&text, &problem.path, problem.order, channels) {
            Ok(model) => model,
            Err(error) => return Some(Err(error.into())),
        };
    if model.states != fit.model.states || candidate.parameters.iter().any(|p| p.is_inverse) {
        return None;
    }
    let shooting = Shooting::new(problem, &model, &problem.train, &fit.unknowns, &fit.ranges);
    let values = shooting.parameter_values(&fit.train.estimate.theta);
    let candidate_unknowns: Vec<CandidateUnknown> = candidate
        .parameters
        .iter()
        .map(CandidateUnknown::from_parameter)
        .collect();
    let mut moved = Vec::new();
    for (parameter, candidate_unknown) in candidate.parameters.iter().zip(&candidate_unknowns) {
        if candidate_unknown.is_shape {
            continue;
        }
        let at = |size: f64| {
            let mut values = values.clone();
            model.set_value(&mut values, &parameter.name, candidate_unknown.base + size);
            values
        };
        let start = candidate_unknown.unknown.scale;
        let size = find_small_size(&model, &at, (&points.few, start)).or_else(|| {
            let all = points.all.deref().as_ref()?;
            find_small_size(&model, &at, (all, start))
        });
        let Some(size) = size else {
            return Some(Err(DiscoverError::NotExcited));
        };
        moved.push(MovedValues {
            values: at(size),
            size,
        });
    }
    let own = fit
        .training_shooting(problem)
        .parameter_values(&fit.train.estimate.theta);
    if model.derive_linear_outputs(&values) != fit.model.derive_linear_outputs(&own) {
        return None;
    }
    Some(Ok(PreparedCandidate {
        candidate: id,
        candidate_unknowns,
        model,
        moved,
    }))
}

/// Returns the size of a parameter that changes accelerations, or rates of first-order states, by a
/// small fraction; `None` if there is no such size.
fn find_small_size(
    model: &EstimationModel,
    at: &dyn Fn(f64) -> Vec<f64>,
    (points, start): (&Points, f64),
) -> Option<f64> {
    let mut size = start;
    let mut found = None;
    for _ in 0..thresholds::MAX_SIZE_ATTEMPTS {
        let mut evaluator = model.create_evaluator(&at(size));
        let change = compute_relative_change(&mut evaluator, points);
        let factor = if change == 0.0 {
            thresholds::MAX_SIZE_FACTOR
        } else if !change.is_finite() {
            1e-3
        } else {
            thresholds::LINEARISATION_ACCELERATION_CHANGE / change
        };
        if thresholds::LINEARISATION_CHANGE_FACTORS.contains(factor) {
            found = Some(size);
        }
        if thresholds::SAME_SIZE_FACTORS.contains(factor) {
            break;
        }
        size *= factor.clamp(
            1.0 / thresholds::MAX_SIZE_FACTOR,
            thresholds::MAX_SIZE_FACTOR,
        );
    }
    found
}

/// Returns the largest relative RMS change of an acceleration or rate of a first-order state.
fn compute_relative_change(evaluator: &mut Evaluator, points: &Points) -> f64 {
    let program = evaluator.program();
    let (first, states) = (program.degrees_of_freedom(), program.states());
    let mut sums = vec![0.0; states - first];
    let mut rates = vec![0.0; states];
    for (number, t) in points.times.iter().enumerate() {
        let (state, inputs) = (&points.states[number], &points.inputs[number]);
        evaluator.rates(
            Point {
                t: *t,
                state,
                inputs,
            },
            &mut rates,
        );
        let pairs = rates[first..].iter().zip(&points.rates[number][first..]);
        for (sum, (a, b)) in sums.iter_mut().zip(pairs) {
            *sum += (a - b) * (a - b);
        }
    }
    let parts = sums.iter().zip(&points.squares);
    let parts = parts.map(|(sum, square)| (sum / square.max(f64::MIN_POSITIVE)).sqrt());
    parts.fold(0.0, |a: f64, b| if b > a || b.is_nan() { b } else { a })
}

/// Returns for each window a column per parameter; no columns for a window whose simulation failed.
fn integrate_drives(
    at: &LinearisedFit,
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    ready: &[PreparedCandidate],
) -> Vec<DMatrix<f64>> {
    let whole = fit.training_shooting(problem);
    let shooting = Shooting {
        fraction: at.fraction,
        ..whole
    };
    let LinearisedFit {
        estimate,
        windows,
        projections: base,
        ..
    } = at;
    let size = windows
        .len()
        .div_ceil(rayon::current_num_threads().max(1))
        .max(1);
    let parts: Vec<Vec<DMatrix<f64>>> = (0..windows.len())
        .collect::<Vec<_>>()
        .par_chunks(size)
        .map(|part| {
            let none = || DMatrix::zeros(0, 0);
            let Some(mut sensitivities) =
                SensitivityEvaluator::with_fixed_unknowns(&shooting, &estimate.theta, 1.0)
            else {
                return part.iter().map(|_| none()).collect();
            };
            let mut evaluators: Vec<(Evaluator, f64)> = ready
                .iter()
                .flat_map(|of| {
                    of.moved
                        .iter()
                        .map(|moved| (of.model.create_evaluator(&moved.values), moved.size))
                })
                .collect();
            let mut own = fit
                .model
                .create_evaluator(&shooting.parameter_values(&estimate.theta));
            part.iter()
                .map(|number| {
                    if base[*number].is_none() {
                        return none();
                    }
                    let window = windows[*number];
                    let moved = evaluators
                        .iter_mut()
                        .map(|(evaluator, size)| PerturbedEvaluator {
                            evaluator,
                            change: *size,
                        });
                    let mut differences = AccelerationDifferences::new(&mut own, moved.collect());
                    let start = &estimate.initial_states[window];
                    let columns = sensitivities.compute_drive_response(
                        window,
                        start,
                        differences.as_drives(),
                    );
                    columns.unwrap_or_else(none)
                })
                .collect()
        })
        .collect();
    parts.into_iter().flatten().collect()
}
