//! Projection of a state onto the holonomic constraints by least squares, in the metric of the coordinates' inertias.
//! Damping suppresses steps in directions in which constraints depend on each other.

use super::geometry::ConstraintGeometry;
use super::vectors::{dot, norm};
use crate::program::evaluator::Point;

/// Largest number of Newton steps. If rows depend on each other, a step only halves the residuals.
const MAX_NEWTON_STEPS: usize = 60;

/// Largest number of damped steps towards a minimum of the residuals.
const MAX_STEPS: usize = 200;

/// Residuals below this fraction of the initial residuals count as zero. If rows depend on each other, each Newton
/// step only halves the residuals.
const MAX_SOLVED_RESIDUAL: f64 = 1e-6;

/// Smallest damping, added to the diagonal of R R^T. It suppresses steps along directions in which the scaled rows
/// are shorter than its square root.
const MIN_DAMPING: f64 = 1e-12;

/// Factor by which the damping grows after a poor step and falls after a good step.
const DAMPING_FACTOR: f64 = 10.0;

/// A step is good if the squared residuals fall by more than this fraction of the expected reduction, and poor below
/// [`POOR_REDUCTION`].
const GOOD_REDUCTION: f64 = 0.75;
const POOR_REDUCTION: f64 = 0.25;

/// Damping above which a step has no effect.
const MAX_DAMPING: f64 = 1e12;

/// State and inputs at which constraints are evaluated.
#[derive(Clone, Copy)]
pub(super) struct EvaluationPoint<'p> {
    pub state: &'p [f64],
    pub inputs: &'p [f64],
}

impl<'p> EvaluationPoint<'p> {
    pub fn point(self) -> Point<'p> {
        Point {
            t: 0.0,
            state: self.state,
            inputs: self.inputs,
        }
    }
}

/// Returns the state near `start` with the smallest residuals of the constraints with indices `holonomic`; `scales`
/// are the lengths of their rows. Newton's method reaches more distant solutions than damped steps, but it finds no
/// minimum with nonzero residuals.
pub(super) fn project(
    rows: &mut dyn ConstraintGeometry,
    place: EvaluationPoint<'_>,
    holonomic: &[usize],
    scales: &[f64],
) -> Vec<f64> {
    let mut projection = Projection {
        rows,
        inputs: place.inputs,
        holonomic,
        scales,
    };
    let newton = projection.solve(place.state);
    let sizes = [place.state, &newton].map(|state| norm(&projection.residuals(state)));
    if sizes[1] <= MAX_SOLVED_RESIDUAL * sizes[0] {
        return newton;
    }
    let minimum = projection.minimise(place.state);
    match norm(&projection.residuals(&minimum)) < sizes[1] || sizes[1].is_nan() {
        true => minimum,
        false => newton,
    }
}

struct Projection<'p> {
    rows: &'p mut dyn ConstraintGeometry,
    inputs: &'p [f64],
    holonomic: &'p [usize],
    scales: &'p [f64],
}

/// Directions of steps: scaled rows and inertias of the coordinates.
struct Directions {
    rows: Vec<Vec<f64>>,
    inertia: Vec<f64>,
}

impl Projection<'_> {
    /// Applies Newton's method; the smallest damping makes dependent rows solvable.
    fn solve(&mut self, from: &[f64]) -> Vec<f64> {
        let mut state = from.to_vec();
        for _ in 0..MAX_NEWTON_STEPS {
            let directions = self.compute_directions(&state);
            let residuals = self.residuals(&state);
            let Some(factors) = solve(&directions.rows, residuals, MIN_DAMPING) else {
                break;
            };
            let moved = directions.step(&state, &factors);
            if moved == state {
                break;
            }
            state = moved;
        }
        state
    }

    /// Minimises the residuals by damped steps (Levenberg-Marquardt). The damping depends on the ratio of the
    /// reduction of the squared residuals to the reduction predicted by the linearised constraints.
    ///
    /// D. W. Marquardt, "An algorithm for least-squares estimation of nonlinear parameters", J. Soc. Ind. Appl.
    /// Math. 11 (1963) 431-441.
    fn minimise(&mut self, from: &[f64]) -> Vec<f64> {
        let mut state = from.to_vec();
        let mut residuals = self.residuals(&state);
        let mut damping = MIN_DAMPING;
        for _ in 0..MAX_STEPS {
            let directions = self.compute_directions(&state);
            loop {
                let Some(factors) = solve(&directions.rows, residuals.clone(), damping) else {
                    return state;
                };
                let moved = directions.step(&state, &factors);
                let after = self.residuals(&moved);
                if norm(&after) < norm(&residuals) {
                    let reduction = norm(&residuals).powi(2) - norm(&after).powi(2);
                    // The linearised residuals after the step equal the damping times the factors.
                    let expected = norm(&residuals).powi(2) - (damping * norm(&factors)).powi(2);
                    if reduction > GOOD_REDUCTION * expected {
                        damping = MIN_DAMPING.max(damping / DAMPING_FACTOR);
                    } else if reduction < POOR_REDUCTION * expected {
                        damping *= DAMPING_FACTOR;
                    }
                    (state, residuals) = (moved, after);
                    break;
                }
                damping *= DAMPING_FACTOR;
                if moved == state || damping > MAX_DAMPING {
                    return state;
                }
            }
        }
        state
    }

    fn compute_directions(&mut self, state: &[f64]) -> Directions {
        let inputs = self.inputs;
        let point = EvaluationPoint { state, inputs }.point();
        let all = self.rows.rows(point);
        let scaled = (self.holonomic.iter()).map(|k| {
            all[*k]
                .iter()
                .map(|entry| entry / self.scales[*k])
                .collect()
        });
        Directions {
            rows: scaled.collect(),
            inertia: self.rows.inertia(point),
        }
    }

    fn residuals(&mut self, state: &[f64]) -> Vec<f64> {
        let inputs = self.inputs;
        let residuals = self
            .rows
            .residuals(EvaluationPoint { state, inputs }.point());
        let scaled = self
            .holonomic
            .iter()
            .map(|k| residuals[*k] / self.scales[*k]);
        scaled.collect()
    }
}

impl Directions {
    /// Returns the state after the step along the rows with these factors.
    fn step(&self, state: &[f64], factors: &[f64]) -> Vec<f64> {
        let entries = state.iter().enumerate();
        let moved = entries.map(|(place, entry)| match self.inertia.get(place) {
            Some(inertia) => {
                let parts = self.rows.iter().zip(factors);
                entry - parts.map(|(row, f)| row[place] * f).sum::<f64>() / inertia.sqrt()
            }
            None => *entry,
        });
        moved.collect()
    }
}

/// Solves (R R^T + damping) y = right by Cholesky factorisation. Returns None if a number is not finite.
fn solve(rows: &[Vec<f64>], mut right: Vec<f64>, damping: f64) -> Option<Vec<f64>> {
    let count = rows.len();
    let mut lower = vec![vec![0.0; count]; count];
    for row in 0..count {
        for column in 0..=row {
            let known = dot(&lower[row][..column], &lower[column][..column]);
            let added = if row == column { damping } else { 0.0 };
            let rest = dot(&rows[row], &rows[column]) + added - known;
            if !rest.is_finite() {
                return None;
            }
            lower[row][column] = match row == column {
                // Exact pivots are at least the damping; rounding can make them smaller.
                true => rest.max(damping).sqrt(),
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
