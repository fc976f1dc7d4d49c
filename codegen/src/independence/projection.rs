//! Projection of a state onto the holonomic constraints by Newton's method, in the metric of the coordinates'
//! inertias. Damping suppresses the directions in which constraints depend on each other.

use super::geometry::ConstraintGeometry;
use super::vectors::dot;
use crate::program::evaluator::Point;

/// Largest number of Newton steps. If rows depend on each other, a step only halves the residuals.
const MAX_STEPS: usize = 60;

/// Added to the diagonal of R R^T: directions with scaled rows shorter than its square root do not move.
const DAMPING: f64 = 1e-12;

/// State and inputs at which constraints are evaluated.
#[derive(Clone, Copy)]
pub(super) struct Place<'p> {
    pub state: &'p [f64],
    pub inputs: &'p [f64],
}

impl<'p> Place<'p> {
    pub fn point(self) -> Point<'p> {
        Point {
            t: 0.0,
            state: self.state,
            inputs: self.inputs,
        }
    }
}

/// Returns the state near `place` with the smallest residuals of the constraints at `holonomic`; `scales` are
/// the lengths of their rows.
pub(super) fn project(
    rows: &mut dyn ConstraintGeometry,
    place: Place<'_>,
    holonomic: &[usize],
    scales: &[f64],
) -> Vec<f64> {
    let mut state = place.state.to_vec();
    for _ in 0..MAX_STEPS {
        let here = Place {
            state: &state,
            ..place
        };
        let inertia = rows.inertia(here.point());
        let (all, residuals) = (rows.rows(here.point()), rows.residuals(here.point()));
        let scaled: Vec<Vec<f64>> = holonomic
            .iter()
            .map(|k| all[*k].iter().map(|entry| entry / scales[*k]).collect())
            .collect();
        let right = holonomic.iter().map(|k| residuals[*k] / scales[*k]);
        let Some(factors) = solve(&scaled, right.collect()) else {
            return state;
        };
        let mut moved = false;
        for (degree, inertia) in inertia.iter().enumerate() {
            let step: f64 = scaled
                .iter()
                .zip(&factors)
                .map(|(row, f)| row[degree] * f)
                .sum();
            let step = step / inertia.sqrt();
            moved |= step.abs() > f64::EPSILON * state[degree].abs();
            state[degree] -= step;
        }
        if !moved {
            break;
        }
    }
    state
}

/// Solves (R R^T + damping) y = right by Cholesky factorisation. Returns None if a number is not finite.
fn solve(rows: &[Vec<f64>], mut right: Vec<f64>) -> Option<Vec<f64>> {
    let count = rows.len();
    let mut lower = vec![vec![0.0; count]; count];
    for row in 0..count {
        for column in 0..=row {
            let known = dot(&lower[row][..column], &lower[column][..column]);
            let damping = if row == column { DAMPING } else { 0.0 };
            let rest = dot(&rows[row], &rows[column]) + damping - known;
            if !rest.is_finite() {
                return None;
            }
            lower[row][column] = match row == column {
                // Rounding can make the pivot smaller than the damping.
                true => rest.max(DAMPING).sqrt(),
                false => rest / lower[column][column],
            };
        }
    }
    for row in 0..count {
        let known = dot(&lower[row][..row], &right[..row]);
        right[row] = (right[row] - known) / lower[row][row];
    }
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|k| lower[k][row] * right[k]).sum();
        right[row] = (right[row] - known) / lower[row][row];
    }
    right.iter().all(|entry| entry.is_finite()).then_some(right)
}
