//! Initial positions of a constrained machine from measured coordinates.
//!
//! The measured coordinates change in small steps from the initial state of the specification to
//! their measured values. The others follow by Newton's method on the constraints. Therefore a
//! linkage stays in its assembly branch, even after several turns of its crank. The projection onto
//! the constraints is not sufficient: it would also change the measured coordinates, and it could
//! end in another branch.

use eomgen_analysis::qr_iteration;
use eomgen_codegen::independence::rows::ConstraintRows;
use eomgen_codegen::independence::vectors::norm;
use eomgen_codegen::program::evaluator::Point;
use eomgen_sim::inputs::HeldInputs;
use nalgebra::{DMatrix, DVector};

/// Maximum step of a measured coordinate, relative to its typical size: 0.1 rad for an angle.
const MAX_STEP_IN_SIZES: f64 = 0.1;

/// Maximum number of steps: 16 turns of a crank.
const MAX_STEPS: usize = 1000;

/// Maximum number of Newton corrections in a step.
const MAX_CORRECTIONS: usize = 20;

/// Weight of the correction of a measured coordinate, relative to the other coordinates.
const MEASURED_WEIGHT: f64 = 1e-3;

/// Singular value of the scaled constraints, relative to the largest, below which the constraints
/// depend on each other.
const MIN_SINGULAR_FRACTION: f64 = 1e-9;

/// Correction, relative to the typical sizes, at which the iteration ends. The projection onto the
/// constraints follows.
const LAST_CORRECTION: f64 = 1e-9;

/// Measured coordinates, and the constraints that determine the other coordinates.
pub(crate) struct MeasuredCoordinates {
    /// Residuals and derivatives of the constraints.
    pub rows: ConstraintRows,
    /// True for each constraint on coordinates, false for one on rates.
    pub is_holonomic: Vec<bool>,
    /// True for each measured coordinate.
    pub is_measured: Vec<bool>,
    /// Typical sizes of the coordinates, SI.
    pub sizes: Vec<f64>,
}

impl MeasuredCoordinates {
    /// Moves a state on the constraints to the measured coordinates of another state, at a time
    /// (s). `None` if the constraints cannot be satisfied in an intermediate step.
    pub fn move_to(
        &mut self,
        state: &mut [f64],
        measured: &[f64],
        (t, inputs): (f64, &HeldInputs),
    ) -> Option<()> {
        let inputs = &inputs.evaluate(t);
        let indices = 0..self.sizes.len();
        let indices: Vec<usize> = indices.filter(|index| self.is_measured[*index]).collect();
        let distance =
            |index: &usize| (measured[*index] - state[*index]).abs() / self.sizes[*index];
        let furthest = indices.iter().map(distance).fold(0.0, f64::max);
        let steps = ((furthest / MAX_STEP_IN_SIZES).ceil() as usize).clamp(1, MAX_STEPS);
        for step in 0..steps {
            let part = 1.0 / (steps - step) as f64;
            for index in &indices {
                state[*index] += part * (measured[*index] - state[*index]);
            }
            self.satisfy_constraints(state, (t, inputs))?;
        }
        Some(())
    }

    /// Corrects the coordinates until the constraints are satisfied.
    fn satisfy_constraints(&mut self, state: &mut [f64], (t, inputs): (f64, &[f64])) -> Option<()> {
        for _ in 0..MAX_CORRECTIONS {
            let point = Point { t, state, inputs };
            let mut rows = self.rows.derivatives(point);
            let mut residuals = self.rows.residuals(point);
            let shares = self.compute_weights();
            let all = rows.iter_mut().zip(&mut residuals).zip(&self.is_holonomic);
            for ((row, residual), is_holonomic) in all {
                row.iter_mut()
                    .zip(&shares)
                    .for_each(|(a, share)| *a *= share);
                let length = norm(row);
                let acts = *is_holonomic && length > 0.0;
                let factor = if acts { 1.0 / length } else { 0.0 };
                row.iter_mut().for_each(|a| *a *= factor);
                *residual *= factor;
            }
            let matrix = DMatrix::from_fn(rows.len(), shares.len(), |row, k| rows[row][k]);
            let factors = qr_iteration::svd(&matrix)?;
            let least = MIN_SINGULAR_FRACTION * factors.singular_values.max();
            let change = factors.solve(&DVector::from_vec(residuals), least).ok()?;
            let mut largest = 0.0_f64;
            for (index, (part, share)) in change.iter().zip(&shares).enumerate() {
                state[index] -= part * share;
                largest = largest.max((part * share / self.sizes[index]).abs());
            }
            if largest <= LAST_CORRECTION {
                return Some(());
            }
            if !largest.is_finite() {
                return None;
            }
        }
        None
    }

    fn compute_weights(&self) -> Vec<f64> {
        let sizes = self.sizes.iter().zip(&self.is_measured);
        let share = |(size, is_measured): (&f64, &bool)| match is_measured {
            true => MEASURED_WEIGHT * size,
            false => *size,
        };
        sizes.map(share).collect()
    }
}
