//! Backward pass over the consistent initial state of a model with constraints.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::derivatives::Derivatives;
use super::pull_back::{BackwardPass, add_product, no_gradient};
use crate::error::Error;

/// Condition of a consistent state, and the change of the state that restores it.
struct Condition {
    /// Derivatives of the residual or of its rate.
    derivatives: Derivatives,
    /// True if the rates are corrected, false if the coordinates are.
    is_of_rates: bool,
    /// True if corrections of coordinates must keep the condition satisfied: constraints of rates.
    is_maintained: bool,
}

/// Conditions whose singular value is below this fraction of the largest depend on others.
const RANK_TOLERANCE: f64 = 1e-10;

impl BackwardPass<'_, '_> {
    /// Converts the derivatives with respect to the consistent initial state into derivatives with respect to the given
    /// one. A simulation starts at the nearest consistent state in the norm of the kinetic energy. The correction is
    /// along M^-1 A^T, for coordinates and for rates.
    pub fn propagate_to_requested_start(&mut self) -> Result<(), Error> {
        let recorded = self.recorded;
        let first = recorded.recording.parts.first();
        let Some(first) =
            first.filter(|_| !recorded.instance.model().model().constraints.is_empty())
        else {
            return Ok(());
        };
        let at = (first.start.0, &recorded.initial[..]);
        let given = recorded.inputs().evaluate(at.0);
        self.evaluator.set_modes(&first.modes);
        let conditions = self.find_conditions(at, &given)?;
        let mass = Cholesky::new(self.evaluator.mass_matrix(at));
        let mass =
            mass.ok_or_else(|| no_gradient(at.0, "the mass matrix is not positive definite"))?;
        let degrees = self.rate_indices().start;
        let mut directions = DMatrix::zeros(at.1.len(), conditions.len());
        let mut rows = DMatrix::zeros(conditions.len(), at.1.len());
        for (place, condition) in conditions.iter().enumerate() {
            let first = if condition.is_of_rates { degrees } else { 0 };
            let by_state = DVector::from_column_slice(&condition.derivatives.state);
            let direction = mass.solve(&by_state.rows(first, degrees));
            directions
                .view_mut((first, place), (degrees, 1))
                .copy_from(&direction);
            rows.row_mut(place).copy_from(&by_state.transpose());
        }
        let decomposed = (&rows * &directions).transpose().svd(true, true);
        let allowed = RANK_TOLERANCE * decomposed.singular_values.max();
        let along = directions.transpose() * DVector::from_column_slice(&self.adjoint);
        let multipliers = decomposed.solve(&along, allowed);
        let multipliers = multipliers.map_err(|cause| no_gradient(at.0, cause))?;
        let row = recorded.inputs().last_sample_index(at.0);
        for (condition, multiplier) in conditions.iter().zip(&multipliers) {
            if condition.is_maintained {
                continue;
            }
            let derivatives = &condition.derivatives;
            for (sums, parts) in [
                (&mut self.adjoint, &derivatives.state),
                (&mut self.parameters, &derivatives.parameters),
                (&mut self.inputs[row], &derivatives.inputs),
            ] {
                add_product(sums, -multiplier, parts);
            }
        }
        Ok(())
    }

    fn find_conditions(
        &mut self,
        at: (f64, &[f64]),
        given: &[f64],
    ) -> Result<Vec<Condition>, Error> {
        let degrees = self.rate_indices().start;
        let constraints = &self.recorded.instance.model().model().constraints;
        let [residuals, rates] = self.evaluator.differentiate_constraints(at, given)?;
        let mut conditions = Vec::new();
        let mut add = |derivatives, is_of_rates, is_maintained| {
            conditions.push(Condition {
                derivatives,
                is_of_rates,
                is_maintained,
            });
        };
        let pairs = residuals.into_iter().zip(rates);
        for (constraint, (residual, rate)) in constraints.iter().zip(pairs) {
            if constraint.is_nonholonomic {
                let mut along = self.evaluator.zeros();
                along.state[..degrees].copy_from_slice(&residual.state[degrees..2 * degrees]);
                add(along, false, true);
                add(residual, true, false);
            } else {
                add(residual, false, false);
                add(rate, true, false);
            }
        }
        Ok(conditions)
    }
}
