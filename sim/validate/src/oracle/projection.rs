//! Projection of states onto dependent (redundant) constraints by the Levenberg-Marquardt method. Newton's method would
//! drift along the constraints to states with more dependent constraints.
//!
//! At states that violate the constraints, their rows are independent and contradict each other, so no accelerations
//! exist. Therefore states of such a model are projected before they are compared.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::Oracle;

/// Maximum number of steps.
const MAX_STEPS: usize = 50;

/// Number of corrections of the rates. The constraints are linear in the rates, so each correction multiplies the error
/// by at most the damping.
const RATE_CORRECTIONS: usize = 20;

/// Damping, added to the squares of the singular values of the scaled rows.
const DAMPING: f64 = 1e-6;

/// Step size at convergence, relative to the largest scaled entry of the state.
const LAST_STEP: f64 = 1e-15;

/// Displacements of the initial state, relative to its entries, at which constraints are tested.
const DISPLACEMENTS: [f64; 4] = [0.0, 0.11, -0.07, 0.19];

/// Values of all constraints at a state.
struct Values {
    /// Constraint Jacobian, each column divided by the square root of its inertia.
    rows: DMatrix<f64>,
    /// Square roots of the inertias of the coordinates.
    roots: DVector<f64>,
    residuals: Vec<f64>,
    /// Rates of holonomic residuals, and residuals of the others.
    rates: Vec<f64>,
}

impl Oracle {
    /// Returns true if the constraints depend on each other.
    pub fn has_dependent_constraints(&self) -> bool {
        self.excess > 0
    }

    /// Returns true if the rate of an input is another input.
    pub fn has_prescribed_motion(&self) -> bool {
        self.input_rates.iter().any(Option::is_some)
    }

    /// Returns the minimum number of dependent constraints over several states that satisfy all constraints.
    pub(super) fn count_excess(&self) -> usize {
        if self.constraints.len() < 2 {
            return 0;
        }
        let inputs = self.typical_inputs.clone();
        let mut least: Option<usize> = None;
        for displacement in DISPLACEMENTS {
            let mut state = self.initial.clone();
            for (place, entry) in state.iter_mut().enumerate() {
                let share = displacement * (1.0 + (place as f64).sin());
                *entry += share * if *entry == 0.0 { 1.0 } else { entry.abs() };
            }
            if !self.project(0.0, &mut state, &inputs) {
                continue;
            }
            let equations = self.equations(0.0, &state, &inputs).ok();
            let found = equations.and_then(|found| found.count_dependent_constraints());
            if let Some(found) = found {
                least = Some(least.map_or(found, |least| least.min(found)));
            }
            if least == Some(0) {
                break;
            }
        }
        least.unwrap_or(0)
    }

    /// Projects a state onto the constraints; returns false if the method does not converge.
    pub fn project(&self, time: f64, state: &mut [f64], inputs: &[f64]) -> bool {
        let size = self.size();
        for _ in 0..MAX_STEPS {
            let Some(values) = self.constraint_values(time, state, inputs) else {
                return false;
            };
            let Some(step) = values.step(&values.residuals) else {
                return false;
            };
            let largest = state[..size].iter().zip(values.roots.iter());
            let largest = largest.fold(0.0_f64, |most, (entry, root)| most.max(entry.abs() * root));
            for (place, change) in step.iter().enumerate() {
                state[place] -= change / values.roots[place];
            }
            if step.amax() > LAST_STEP * largest {
                continue;
            }
            for _ in 0..RATE_CORRECTIONS {
                let Some(values) = self.constraint_values(time, state, inputs) else {
                    return false;
                };
                let Some(step) = values.step(&values.rates) else {
                    return false;
                };
                for (place, change) in step.iter().enumerate() {
                    state[size + place] -= change / values.roots[place];
                }
            }
            return true;
        }
        false
    }

    fn constraint_values(&self, time: f64, state: &[f64], inputs: &[f64]) -> Option<Values> {
        let scene = self.scene(time, state, None, inputs).ok()?;
        let equations = self.evaluate_equations(&scene);
        let roots = equations.mass.diagonal().map(f64::sqrt);
        let rows = DMatrix::from_fn(self.constraints.len(), self.size(), |row, column| {
            equations.constraints[row].gradient[column].value / roots[column]
        });
        let values = self.constraints.iter().map(|known| known.values(&scene));
        let (residuals, rates): (Vec<f64>, Vec<f64>) = values.unzip();
        let all = rows.iter().chain(&residuals).chain(&rates);
        let is_finite = all.into_iter().all(|entry| entry.is_finite());
        is_finite.then_some(Values {
            rows,
            roots,
            residuals,
            rates,
        })
    }
}

impl Values {
    /// Returns the damped scaled change that removes the residuals.
    fn step(&self, residuals: &[f64]) -> Option<DVector<f64>> {
        let mut rows = self.rows.clone();
        let mut right = DVector::from_column_slice(residuals);
        for (place, mut row) in rows.row_iter_mut().enumerate() {
            let length = row.norm();
            if length > 0.0 {
                row /= length;
                right[place] /= length;
            }
        }
        let count = rows.nrows();
        let damped =
            &rows * rows.transpose() + DMatrix::from_diagonal_element(count, count, DAMPING);
        Some(rows.tr_mul(&Cholesky::new(damped)?.solve(&right)))
    }
}
