//! Estimates where unknowns share a direction that the records hardly show, such as the gain of the
//! only channel with every parameter of an equation. Neighbouring motions that come along are off by a
//! few percent, which would decide along such a direction in place of the priors; central differences
//! of whole motions are the derivatives of what is minimised.

use nalgebra::{DMatrix, DVector};

use crate::fit::gauss_newton::{Estimate, evaluated, step};
use crate::fit::information::record_factor;
use crate::fit::prior::InitialStatePrior;
use crate::fit::sensitivity::WindowDerivatives;
use crate::fit::shooting::{Residual, Shooting};
use crate::ids::UnknownId;
use crate::thresholds;

/// Whether unknowns share a direction along which derivatives that are off by
/// [`thresholds::TANGENT_ERROR`] say more than the records do, and whole motions say what is true: where
/// motions have switches, impacts fold small differences, and steps end in one fold or another.
pub(crate) fn is_ill_conditioned(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    initial_states: &[Vec<f64>],
    linear: &[Option<WindowDerivatives>],
) -> bool {
    if !shooting.model.program().guards.is_empty() {
        return false;
    }
    let factor = record_factor(shooting.unknowns.len(), prior, initial_states, linear);
    let shown = factor.column_iter().filter(|column| column.norm() > 0.0);
    let columns: Vec<DVector<f64>> = shown.map(|column| column.normalize()).collect();
    !columns.is_empty()
        && DMatrix::from_columns(&columns).singular_values().min() < thresholds::TANGENT_ERROR
}

/// Gauss-Newton steps by differences of whole motions, until what they gain is less than the priors
/// can tell; and the derivatives at the end.
pub(crate) fn refined(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    from: Estimate,
) -> (Estimate, Vec<Option<WindowDerivatives>>) {
    let mut present = evaluated(shooting, prior, from.theta, from.initial_states);
    let mut linear = central_differences(shooting, &present);
    for _ in 0..thresholds::VALLEY_STEPS {
        let Some(next) = step(shooting, prior, &present, &linear) else {
            break;
        };
        let decrease = present.cost - next.cost;
        present = next;
        linear = central_differences(shooting, &present);
        if decrease < thresholds::LEAST_INFORMATION * shooting.prior_weight {
            break;
        }
    }
    (present, linear)
}

/// Residuals and derivatives of every window; none where a motion cannot be followed.
fn central_differences(
    shooting: &Shooting<'_>,
    estimate: &Estimate,
) -> Vec<Option<WindowDerivatives>> {
    let Estimate {
        theta,
        initial_states,
        ..
    } = estimate;
    let by_unknown: Vec<Columns> = (UnknownId::first(theta.len()))
        .map(|id| {
            let unknown = &shooting.unknowns[id];
            let size = thresholds::CENTRAL_QUOTIENT * unknown.scale;
            // Beyond a bound that a prior sets there is motion too.
            let reach = unknown.bounds.hull(unknown.limits);
            let ends = [size, -size].map(|change| {
                let mut moved = theta.clone();
                moved[id] = reach.clamp(theta[id] + change);
                moved
            });
            let span = ends[0][id] - ends[1][id];
            let [after, before] = ends.map(|theta| shooting.residuals(&theta, initial_states));
            columns(after, before, span)
        })
        .collect();
    let by_state: Vec<Columns> = (shooting.ranges.unwrap_or_default().iter().enumerate())
        .map(|(state, range)| {
            let size = thresholds::CENTRAL_QUOTIENT * range;
            let [after, before] = [size, -size].map(|change| {
                let mut moved = initial_states.clone();
                moved.iter_mut().for_each(|start| start[state] += change);
                shooting.residuals(theta, &moved)
            });
            columns(after, before, 2.0 * size)
        })
        .collect();
    let residuals = shooting.residuals(theta, initial_states);
    let windows = residuals.into_iter().enumerate();
    windows
        .map(|(window, residual)| {
            let Residual { values, last } = residual?;
            let matrix = |columns: &[Columns]| {
                let columns = columns.iter().map(|column| column[window].clone());
                let columns: Vec<DVector<f64>> = columns.collect::<Option<_>>()?;
                Some(match columns.is_empty() {
                    true => DMatrix::zeros(values.len(), 0),
                    false => DMatrix::from_columns(&columns),
                })
            };
            Some(WindowDerivatives {
                by_state: matrix(&by_state)?,
                by_unknown: matrix(&by_unknown)?,
                residual: DVector::from_vec(values),
                last,
            })
        })
        .collect()
}

/// A derivative of each window's residuals; none where a motion cannot be followed.
type Columns = Vec<Option<DVector<f64>>>;

/// Difference quotients of each window's residuals.
fn columns(after: Vec<Option<Residual>>, before: Vec<Option<Residual>>, span: f64) -> Columns {
    let windows = after.into_iter().zip(before);
    windows
        .map(|(after, before)| {
            let difference = DVector::from_vec(after?.values) - DVector::from_vec(before?.values);
            let quotient = difference / span;
            (quotient.iter().all(|entry| entry.is_finite())).then_some(quotient)
        })
        .collect()
}
