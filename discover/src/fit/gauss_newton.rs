//! Estimation by separable Gauss-Newton steps on multiple shooting (Bock 1983). The initial state
//! of each window is eliminated from its residuals by a QR factorisation (variable projection:
//! Golub and Pereyra 1973), so that the reduced problem depends only on the unknowns. Steps are
//! shortened until the cost decreases. The step of the initial state is shortened for each window
//! separately, because impacts make the outputs irregular.

use crate::ids::WindowId;
use crate::interval::Interval;
use crate::model::admissible_states::AdmissibleStates;
use crate::model::unknowns::NormalPrior;
use nalgebra::{DMatrix, DVector};

use crate::fit::bounded_least_squares::solve_least_squares;
use crate::fit::prior::InitialStatePrior;
use crate::fit::sensitivity::{SensitivityEvaluator, WindowDerivatives, linearise_windows};
use crate::fit::shooting::{Residual, Shooting};
use crate::fit::variable_projection::{
    ReducedBlock, compute_triangular_factor, eliminate_initial_state,
};
use crate::thresholds;

/// Estimate of unknowns and initial states with its cost.
#[derive(Clone, Debug, Default)]
pub struct Estimate {
    /// Unknowns.
    pub theta: Vec<f64>,
    /// Initial state of each window.
    pub initial_states: Vec<Vec<f64>>,
    /// Sum of squared residuals of each window, in standard deviations; not finite if the
    /// simulation failed.
    pub squares: Vec<f64>,
    /// Sum of squares over the windows, plus the cost of the priors.
    pub cost: f64,
}

/// Estimates unknowns and initial states from initial values.
pub fn run_damped_gauss_newton(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    theta: &[f64],
    initial_states: &[Vec<f64>],
    steps: usize,
) -> Estimate {
    let mut present = evaluate_cost(shooting, prior, theta.to_vec(), initial_states.to_vec());
    for _ in 0..steps {
        let linear = compute_derivatives(shooting, &present);
        let Some(next) = take_step(shooting, prior, &present, &linear) else {
            break;
        };
        let decrease = present.cost - next.cost;
        let converged = decrease < thresholds::MIN_GAUSS_NEWTON_DECREASE * present.cost;
        present = next;
        if converged {
            break;
        }
    }
    present
}

/// Returns the RMS residual, in standard deviations, but at least 1.
pub fn residual_level(shooting: &Shooting<'_>, estimate: &Estimate) -> f64 {
    let finite = estimate.squares.iter().filter(|s| s.is_finite());
    let (sum, count) = finite.fold((0.0, 0), |(sum, n), s| (sum + s, n + 1));
    let samples: usize = shooting.windows.windows.iter().map(|w| w.times.len()).sum();
    let per_window = samples as f64 / shooting.windows.windows.len().max(1) as f64;
    let numbers = per_window * shooting.channel_count() as f64 * f64::from(count.max(1));
    (sum / numbers).sqrt().max(1.0)
}

/// Computes the residuals and derivatives of all windows at an estimate. The steps of difference
/// quotients depend on the size of the residuals.
pub(crate) fn compute_derivatives(
    shooting: &Shooting<'_>,
    at: &Estimate,
) -> Vec<Option<WindowDerivatives>> {
    linearise_windows(
        shooting,
        &at.theta,
        &at.initial_states,
        residual_level(shooting, at),
    )
}

/// Evaluates the cost for given unknowns and initial states.
pub fn evaluate_cost(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    theta: Vec<f64>,
    initial_states: Vec<Vec<f64>>,
) -> Estimate {
    let residuals = shooting.compute_residuals(&theta, &initial_states);
    let squares: Vec<f64> = residuals.iter().map(sum_of_squares).collect();
    compute_total_costs(shooting, prior, theta, initial_states, squares)
}

/// Returns the sum of squares of a window; infinite if the simulation failed.
pub(crate) fn sum_of_squares(residual: &Option<Residual>) -> f64 {
    residual
        .as_ref()
        .map_or(f64::INFINITY, Residual::sum_of_squares)
}

/// Returns the contribution of the priors of unknowns to the cost.
fn compute_prior_cost(shooting: &Shooting<'_>, theta: &[f64]) -> f64 {
    let terms = shooting.unknowns.iter().zip(theta).map(|(unknown, value)| {
        let unknown_before = NormalPrior {
            mean: *value,
            sd: 1.0,
        };
        let NormalPrior { mean, sd } = unknown.prior.unwrap_or(unknown_before);
        ((value - mean) / sd).powi(2)
    });
    shooting.prior_weight * terms.sum::<f64>()
}

fn compute_total_costs(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    theta: Vec<f64>,
    initial_states: Vec<Vec<f64>>,
    squares: Vec<f64>,
) -> Estimate {
    let windows = WindowId::first(initial_states.len());
    let of_initial_states = windows
        .zip(&initial_states)
        .map(|(window, state)| prior.compute_cost(window, state));
    let cost = squares.iter().sum::<f64>()
        + of_initial_states.sum::<f64>()
        + compute_prior_cost(shooting, &theta);
    Estimate {
        theta,
        initial_states,
        squares,
        cost,
    }
}

/// Returns the unknowns after a fraction of a step, within the bounds.
pub(crate) fn apply_fraction(
    shooting: &Shooting<'_>,
    present: &Estimate,
    change: &DVector<f64>,
    part: f64,
) -> Vec<f64> {
    let pairs = present
        .theta
        .iter()
        .zip(change.iter())
        .zip(shooting.unknowns);
    pairs
        .map(|((value, change), unknown)| unknown.clamp(value + part * change))
        .collect()
}

/// Eliminates the initial states from the derivatives of the windows.
pub(crate) fn eliminate_initial_states(
    prior: &InitialStatePrior,
    present: &Estimate,
    linear: &[Option<WindowDerivatives>],
) -> Vec<Option<ReducedBlock>> {
    let windows = WindowId::first(linear.len()).zip(linear);
    windows
        .map(|(window, linear)| {
            Some(eliminate_initial_state(
                linear.as_ref()?,
                prior,
                window,
                &present.initial_states[window],
            ))
        })
        .collect()
}

/// Returns the next estimate, if its cost is lower.
fn take_step(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    present: &Estimate,
    linear: &[Option<WindowDerivatives>],
) -> Option<Estimate> {
    step_with_correction(shooting, prior, present, linear, |next| next)
}

/// Returns the next estimate after a correction, if its cost is lower.
pub(crate) fn step_with_correction(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    present: &Estimate,
    linear: &[Option<WindowDerivatives>],
    correction: impl Fn(Estimate) -> Estimate,
) -> Option<Estimate> {
    let windows = eliminate_initial_states(prior, present, linear);
    for damping in thresholds::STEP_DAMPING {
        let change = solve_step(shooting, present, &windows, damping);
        for part in thresholds::STEP_FRACTIONS {
            let theta = apply_fraction(shooting, present, &change, part);
            let next = correction(follow_unknowns(shooting, prior, present, &windows, theta));
            if next.cost < present.cost {
                return Some(next);
            }
            if change.norm() == 0.0 {
                return None;
            }
        }
    }
    None
}

/// Returns the bounded least-squares step of the unknowns.
pub(crate) fn solve_step(
    shooting: &Shooting<'_>,
    present: &Estimate,
    windows: &[Option<ReducedBlock>],
    damping: f64,
) -> DVector<f64> {
    let count = shooting.unknowns.len();
    let mut factor = DMatrix::zeros(count + 1, count + 1);
    for window in windows.iter().flatten() {
        factor = compute_triangular_factor(&factor, &window.reduced_columns());
    }
    let mut rows = DMatrix::zeros(2 * count, count + 1);
    for (column, unknown) in shooting.unknowns.iter().enumerate() {
        if let Some(NormalPrior { mean, sd }) = unknown.prior {
            let weight = shooting.prior_weight.sqrt() / sd;
            rows[(column, column)] = weight;
            rows[(column, count)] = (present.theta[column] - mean) * weight;
        }
        rows[(count + column, column)] = damping * factor.column(column).norm();
    }
    let factor = compute_triangular_factor(&factor, &rows);
    let a = factor.columns(0, count).into_owned();
    let b = -factor.column(count).into_owned();
    let bounds: Vec<Interval> = (shooting.unknowns.iter().zip(&present.theta))
        .map(|(unknown, value)| unknown.bounds.shift_origin_to(*value).extend_to_zero())
        .collect();
    solve_least_squares(&a, &b, &bounds)
}

/// Returns the estimate for new unknowns. Each window takes the step of its initial state with the
/// lowest cost.
pub(crate) fn follow_unknowns(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    present: &Estimate,
    windows: &[Option<ReducedBlock>],
    theta: Vec<f64>,
) -> Estimate {
    let change = DVector::from_iterator(
        theta.len(),
        theta.iter().zip(&present.theta).map(|(new, old)| new - old),
    );
    let values = shooting.parameter_values(&theta);
    let mut admissible = AdmissibleStates::new(shooting.model, &values);
    let mut moved = |damping: f64| -> Vec<Vec<f64>> {
        let pairs = present.initial_states.iter().zip(windows);
        let pairs = WindowId::first(windows.len()).zip(pairs);
        pairs
            .map(|(id, (start, window))| {
                let window = window.as_ref().filter(|_| shooting.ranges.is_some());
                let step = window.and_then(|w| w.solve_initial_state_step(&change, damping, prior));
                move_initial_state(shooting, &mut admissible, (id, start), step)
            })
            .collect()
    };
    let mut best = evaluate_cost(
        shooting,
        prior,
        theta.clone(),
        moved(thresholds::INITIAL_STATE_DAMPING[0]),
    );
    if shooting.ranges.is_none() {
        return best;
    }
    // For most windows the full step decreases the cost. The step is damped for the others, for all
    // of them at once.
    for damping in &thresholds::INITIAL_STATE_DAMPING[1..] {
        let stuck: Vec<WindowId> = WindowId::first(best.squares.len())
            .filter(|w| {
                compute_window_cost(&best, prior, *w) > compute_window_cost(present, prior, *w)
            })
            .collect();
        if stuck.is_empty() {
            break;
        }
        let damped = moved(*damping);
        let squares = compute_squares(shooting, &theta, &damped, &stuck);
        for (window, square) in stuck.iter().zip(squares) {
            let with_prior = square + prior.compute_cost(*window, &damped[*window]);
            if with_prior < compute_window_cost(&best, prior, *window) {
                best.squares[*window] = square;
                best.initial_states[*window].clone_from(&damped[*window]);
            }
        }
    }
    let Estimate {
        initial_states,
        squares,
        ..
    } = best;
    compute_total_costs(shooting, prior, theta, initial_states, squares)
}

/// Corrects the initial states after a long step of the unknowns. The derivatives are those before
/// the step, the residuals those after it. Corrections of a window end when its cost no longer
/// decreases.
pub(crate) fn correct_initial_states(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    estimate: Estimate,
    near: &[Option<WindowDerivatives>],
) -> Estimate {
    if shooting.ranges.is_none() {
        return estimate;
    }
    let held = DVector::zeros(shooting.unknowns.len());
    let values = shooting.parameter_values(&estimate.theta);
    let mut admissible = AdmissibleStates::new(shooting.model, &values);
    let mut best = estimate;
    let mut residuals = shooting.compute_residuals(&best.theta, &best.initial_states);
    for _ in 0..thresholds::MAX_STATE_CORRECTIONS {
        let windows = WindowId::first(residuals.len()).zip(&residuals).zip(near);
        let moved = windows.map(|((window, residual), near)| {
            let start = &best.initial_states[window];
            let step = residual.as_ref().zip(near.as_ref());
            let step = step.and_then(|(residual, near)| {
                let here = WindowDerivatives {
                    residual: DVector::from_column_slice(&residual.values),
                    ..near.clone()
                };
                eliminate_initial_state(&here, prior, window, start)
                    .solve_initial_state_step(&held, 0.0, prior)
            });
            move_initial_state(shooting, &mut admissible, (window, start), step)
        });
        let moved: Vec<Vec<f64>> = moved.collect();
        let corrected = shooting.compute_residuals(&best.theta, &moved);
        let before = best.cost;
        let windows = WindowId::first(residuals.len()).zip(corrected).zip(moved);
        for (((window, corrected), start), residual) in windows.zip(&mut residuals) {
            let square = sum_of_squares(&corrected);
            if square + prior.compute_cost(window, &start)
                < compute_window_cost(&best, prior, window)
            {
                best.squares[window] = square;
                best.initial_states[window] = start;
                *residual = corrected;
            }
        }
        let Estimate {
            theta,
            initial_states,
            squares,
            ..
        } = best;
        best = compute_total_costs(shooting, prior, theta, initial_states, squares);
        if before - best.cost < thresholds::MIN_FINAL_DECREASE * shooting.prior_weight {
            break;
        }
    }
    best
}

/// Returns the initial state of a window after a step, moved to the nearest admissible state.
/// Without a step the state is unchanged.
fn move_initial_state(
    shooting: &Shooting<'_>,
    admissible: &mut AdmissibleStates<'_>,
    (window, start): (WindowId, &[f64]),
    step: Option<DVector<f64>>,
) -> Vec<f64> {
    let Some(step) = step else {
        return start.to_vec();
    };
    let moved = start.iter().zip(step.iter()).map(|(x, d)| x + d);
    let window = &shooting.windows.windows[window];
    let at = (window.times[0], shooting.windows.inputs(window));
    admissible.find_nearest(moved.collect(), at)
}

fn compute_window_cost(estimate: &Estimate, prior: &InitialStatePrior, window: WindowId) -> f64 {
    estimate.squares[window] + prior.compute_cost(window, &estimate.initial_states[window])
}

/// Returns the sums of squares of the listed windows.
fn compute_squares(
    shooting: &Shooting<'_>,
    theta: &[f64],
    initial_states: &[Vec<f64>],
    windows: &[WindowId],
) -> Vec<f64> {
    use rayon::prelude::*;
    let (values, sensors) = (
        shooting.parameter_values(theta),
        shooting.sensor_values(theta),
    );
    let size = windows
        .len()
        .div_ceil(rayon::current_num_threads().max(1))
        .max(1);
    let parts: Vec<Vec<f64>> = windows
        .par_chunks(size)
        .map(|part| {
            let mut simulation = shooting.model.create_simulation(&values).ok();
            part.iter()
                .map(|window| {
                    let residual = simulation.as_mut().and_then(|simulation| {
                        shooting.compute_residual(
                            simulation,
                            &sensors,
                            *window,
                            &initial_states[*window],
                        )
                    });
                    sum_of_squares(&residual)
                })
                .collect()
        })
        .collect();
    parts.into_iter().flatten().collect()
}

/// Fits the initial state of one window for given unknowns, by damped steps over growing fractions
/// of the window. A short motion is nearly linear in its initial state; impacts make the outputs of
/// a long motion irregular.
pub fn fit_initial_state(
    sensitivities: &mut SensitivityEvaluator<'_>,
    prior: &InitialStatePrior,
    window: WindowId,
    start: Vec<f64>,
    horizons: &[f64],
) -> Option<Vec<f64>> {
    let mut present = start;
    for horizon in horizons {
        sensitivities.truncate(*horizon);
        present = fit_on_segment(sensitivities, prior, window, present)?;
    }
    Some(present)
}

fn fit_on_segment(
    sensitivities: &mut SensitivityEvaluator<'_>,
    prior: &InitialStatePrior,
    window: WindowId,
    start: Vec<f64>,
) -> Option<Vec<f64>> {
    let total = |residual: &Residual, start: &[f64]| {
        residual.sum_of_squares() + prior.compute_cost(window, start)
    };
    let mut cost = total(&sensitivities.compute_residual(window, &start)?, &start);
    let mut present = start;
    for _ in 0..thresholds::MAX_INNER_STEPS {
        let linear = sensitivities.linearise(window, &present)?;
        let block = eliminate_initial_state(&linear, prior, window, &present);
        let held = DVector::zeros(linear.by_unknown.ncols());
        let better = thresholds::INITIAL_STATE_DAMPING
            .iter()
            .find_map(|damping| {
                let step = block.solve_initial_state_step(&held, *damping, prior)?;
                let moved = present.iter().zip(step.iter()).map(|(x, d)| x + d);
                let moved = sensitivities.find_admissible_state(window, moved.collect());
                let total = total(&sensitivities.compute_residual(window, &moved)?, &moved);
                (total < cost).then_some((moved, total))
            });
        let Some((moved, total)) = better else {
            break;
        };
        let converged = cost - total < thresholds::MIN_INNER_DECREASE * total;
        (present, cost) = (moved, total);
        if converged {
            break;
        }
    }
    Some(present)
}
