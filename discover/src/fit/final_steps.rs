//! Final steps of a fit to the minimum of the cost, with a wide prior of the initial states. If the
//! model is linear between switches, the derivatives are exact. For other models, central
//! differences of simulated motions are used. The errors of forward differences and of tangent
//! vectors would move the fit along directions that the records hardly determine.

use nalgebra::{DMatrix, DVector};

use crate::fit::gauss_newton::{
    Estimate, compute_derivatives, correct_initial_states, evaluate_cost, step_with_correction,
};
use crate::fit::initial_states::update_carried_prior;
use crate::fit::jump_free_quotients::limit_quotient;
use crate::fit::prior::InitialStatePrior;
use crate::fit::sensitivity::{WindowDerivatives, compute_range_along, move_along};
use crate::fit::shooting::{Residual, Shooting};
use crate::fit::variable_projection::compute_triangular_factor;
use crate::ids::{UnknownId, WindowId};
use crate::thresholds;

/// Standard deviation of the initial value of a constant state, as a fraction of its range.
const MIN_STATE_SD_IN_RANGES: f64 = 1e-6;

/// Returns rows that transform the deviation of a state from its mean along the windows to unit
/// covariance. Both ends of a stiff spring move together, so their initial states must be
/// correlated.
pub(crate) fn compute_whitening(
    shooting: &Shooting<'_>,
    estimate: &Estimate,
) -> Option<DMatrix<f64>> {
    let ranges = shooting.ranges?;
    let mut simulation = shooting
        .model
        .create_simulation(&shooting.parameter_values(&estimate.theta))
        .ok()?;
    let mut states = Vec::new();
    for window in WindowId::first(shooting.windows.windows.len()) {
        let samples = &shooting.windows.windows[window];
        let inputs = shooting.windows.inputs(samples);
        let motion =
            simulation.simulate_states(&estimate.initial_states[window], &samples.times, inputs);
        states.extend(motion.ok()?);
    }
    let count = states.len() as f64;
    let scaled = DMatrix::from_fn(states.len(), ranges.len(), |row, state| {
        states[row][state] / ranges[state]
    });
    let mean = scaled.row_mean();
    let deviations = DMatrix::from_fn(states.len(), ranges.len(), |row, state| {
        (scaled[(row, state)] - mean[state]) / count.sqrt()
    });
    let least = DMatrix::from_diagonal_element(ranges.len(), ranges.len(), MIN_STATE_SD_IN_RANGES);
    let factor = compute_triangular_factor(&deviations, &least);
    let inverse = factor.transpose().try_inverse()?;
    Some(DMatrix::from_fn(
        ranges.len(),
        ranges.len(),
        |row, state| inverse[(row, state)] / ranges[state],
    ))
}

/// Takes the final steps of a fit. Returns the estimate and its derivatives.
pub(crate) fn run_final_steps(
    shooting: &Shooting<'_>,
    prior: &mut InitialStatePrior,
    from: Estimate,
) -> (Estimate, Vec<Option<WindowDerivatives>>) {
    let values = shooting.parameter_values(&from.theta);
    let simulation = shooting.model.create_simulation(&values);
    if simulation.is_ok_and(|simulation| simulation.has_exact_derivatives()) {
        return take_steps(shooting, prior, from, compute_derivatives);
    }
    let near = compute_derivatives(shooting, &from);
    take_steps(shooting, prior, from, |shooting, estimate| {
        compute_central_differences(shooting, estimate, &near)
    })
}

/// Takes Gauss-Newton steps with the given derivatives, until the decrease of the cost is
/// negligible. Returns the estimate and its derivatives.
fn take_steps(
    shooting: &Shooting<'_>,
    prior: &mut InitialStatePrior,
    from: Estimate,
    derivatives: impl Fn(&Shooting<'_>, &Estimate) -> Vec<Option<WindowDerivatives>>,
) -> (Estimate, Vec<Option<WindowDerivatives>>) {
    let with_carried = |prior: &mut InitialStatePrior, estimate: Estimate| {
        update_carried_prior(shooting, prior, &estimate.theta, &estimate.initial_states);
        evaluate_cost(shooting, prior, estimate.theta, estimate.initial_states)
    };
    let mut present = with_carried(prior, from);
    let mut linear = derivatives(shooting, &present);
    for _ in 0..thresholds::MAX_FINAL_STEPS {
        let corrected = |next| correct_initial_states(shooting, prior, next, &linear);
        let Some(next) = step_with_correction(shooting, prior, &present, &linear, corrected) else {
            break;
        };
        let decrease = present.cost - next.cost;
        present = with_carried(prior, next);
        linear = derivatives(shooting, &present);
        if decrease < thresholds::MIN_FINAL_DECREASE * shooting.prior_weight {
            break;
        }
    }
    (present, linear)
}

/// Returns residuals and derivatives of every window; `None` if its simulation failed. The
/// derivatives in `near` limit the differences: each output changes by less than a fraction of its
/// noise, because a motion with dry friction is linear only in this range.
fn compute_central_differences(
    shooting: &Shooting<'_>,
    estimate: &Estimate,
    near: &[Option<WindowDerivatives>],
) -> Vec<Option<WindowDerivatives>> {
    let Estimate {
        theta,
        initial_states,
        ..
    } = estimate;
    let residuals = shooting.compute_residuals(theta, initial_states);
    let quotients = Quotients {
        shooting,
        residuals: &residuals,
    };
    let by_unknown: Vec<Columns> = (UnknownId::first(theta.len()))
        .map(|id| {
            let unknown = &shooting.unknowns[id];
            let columns = near
                .iter()
                .flatten()
                .map(|of| of.by_unknown.column(id.index()));
            let steepest = columns.map(|column| column.amax()).fold(0.0, f64::max);
            let size = choose_change(unknown.scale, steepest);
            // A bound that comes only from a prior does not limit the difference quotient: the
            // model can be simulated beyond it.
            let reach = unknown.bounds.join(unknown.bounds_without_prior);
            let ends = [size, -size].map(|change| {
                let mut moved = theta.clone();
                moved[id] = reach.clamp(theta[id] + change);
                moved
            });
            let steps = [ends[0][id] - theta[id], theta[id] - ends[1][id]];
            let ends = ends.map(|theta| shooting.compute_residuals(&theta, initial_states));
            quotients.columns(ends, &vec![steps; initial_states.len()])
        })
        .collect();
    let ranges = shooting.ranges.unwrap_or_default();
    let all_states = DMatrix::identity(ranges.len(), ranges.len());
    let directions: Vec<&DMatrix<f64>> = (near.iter())
        .map(|of| of.as_ref().map_or(&all_states, |of| &of.directions))
        .collect();
    let most = directions.iter().map(|of| of.ncols()).max().unwrap_or(0);
    let by_state: Vec<Columns> = (0..most)
        .map(|number| {
            let sizes = near.iter().zip(&directions).map(|(of, directions)| {
                if number >= directions.ncols() {
                    return 0.0;
                }
                let steepest = of.as_ref().map(|of| of.by_state.column(number).amax());
                let range = compute_range_along(&directions.column(number), ranges);
                choose_change(range, steepest.unwrap_or(0.0))
            });
            let sizes: Vec<f64> = sizes.collect();
            let ends = [1.0, -1.0].map(|sign| {
                let mut moved = initial_states.clone();
                for ((start, size), directions) in moved.iter_mut().zip(&sizes).zip(&directions) {
                    if number < directions.ncols() {
                        *start = move_along(start, &directions.column(number), sign * size);
                    }
                }
                shooting.compute_residuals(theta, &moved)
            });
            let steps: Vec<[f64; 2]> = sizes.iter().map(|size| [*size; 2]).collect();
            quotients.columns(ends, &steps)
        })
        .collect();
    let windows = residuals.into_iter().enumerate();
    windows
        .map(|(window, residual)| {
            let Residual {
                values,
                end_state: last,
            } = residual?;
            let matrix = |columns: &[Columns]| {
                let columns = columns.iter().map(|column| column[window].clone());
                let columns: Vec<DVector<f64>> = columns.collect::<Option<_>>()?;
                Some(match columns.is_empty() {
                    true => DMatrix::zeros(values.len(), 0),
                    false => DMatrix::from_columns(&columns),
                })
            };
            Some(WindowDerivatives {
                by_state: matrix(&by_state[..directions[window].ncols()])?,
                directions: directions[window].clone(),
                by_unknown: matrix(&by_unknown)?,
                residual: DVector::from_vec(values),
                end_state: last,
            })
        })
        .collect()
}

/// Derivative of the residuals of each window; `None` if its simulation failed.
type Columns = Vec<Option<DVector<f64>>>;

/// Returns the step of a difference quotient. `scale`: scale of the unknown; `steepest`: largest
/// derivative of an output, in standard deviations of its noise.
fn choose_change(scale: f64, steepest: f64) -> f64 {
    (thresholds::CENTRAL_QUOTIENT_IN_SCALES * scale)
        .min(thresholds::QUOTIENT_OUTPUT_CHANGE / steepest)
}

/// Difference quotients of the residuals.
struct Quotients<'q> {
    shooting: &'q Shooting<'q>,
    residuals: &'q [Option<Residual>],
}

impl Quotients<'_> {
    /// Returns the quotients of the residuals of each window. `ends`: residuals after a positive
    /// and a negative step; `steps`: sizes of both steps for each window, not negative.
    fn columns(&self, ends: [Vec<Option<Residual>>; 2], steps: &[[f64; 2]]) -> Columns {
        let [after, before] = ends;
        let windows = after.into_iter().zip(before).zip(self.residuals).zip(steps);
        windows
            .map(|(((after, before), own), steps)| {
                self.column([after?, before?], own.as_ref()?, steps)
            })
            .collect()
    }

    fn column(
        &self,
        [after, before]: [Residual; 2],
        own: &Residual,
        [to_after, to_before]: &[f64; 2],
    ) -> Option<DVector<f64>> {
        let channels = self.shooting.channel_count();
        let quotient = |row: usize| {
            let [after, before] = [&after, &before].map(|end| end.values[row]);
            let has_both_sides = *to_after > 0.0 && *to_before > 0.0;
            match has_both_sides && self.shooting.model.has_jumps(row % channels) {
                true => limit_quotient(
                    (after - own.values[row]) / to_after,
                    (own.values[row] - before) / to_before,
                ),
                false => (after - before) / (to_after + to_before),
            }
        };
        let column = DVector::from_fn(own.values.len(), |row, _| quotient(row));
        (column.iter().all(|entry| entry.is_finite())).then_some(column)
    }
}
