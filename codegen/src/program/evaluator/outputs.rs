//! Requested outputs of a program. Each function returns false if the program lacks the output.

use super::{Evaluator, Point, Stage};
use crate::program::BlockPlace;
use crate::program::{
    Argument, Extent, Jacobian, JacobianBlock, Products, RowValues, ValueId, Variable,
};

impl Evaluator {
    /// Computes c - f, one number for each degree of freedom.
    pub fn bias_forces(&mut self, point: Point<'_>, out: &mut [f64]) -> bool {
        let Some(rows) = self.program.outputs.bias_forces.clone() else {
            return false;
        };
        self.compute(Stage::BiasForces, &point);
        self.copy_rows(&rows.scalars, &rows.modal, out);
        true
    }

    /// Computes M a + c - f for the given accelerations, one number for each degree of freedom.
    pub fn inverse_dynamics(
        &mut self,
        point: Point<'_>,
        accelerations: &[f64],
        out: &mut [f64],
    ) -> bool {
        let Some(rows) = self.program.outputs.inverse_dynamics.clone() else {
            return false;
        };
        self.set_argument(Argument::Accelerations, accelerations, &[]);
        self.compute(Stage::InverseDynamics, &point);
        self.copy_rows(&rows.scalars, &rows.modal, out);
        true
    }

    /// Computes the rates of the guards, [`Evaluator::guard_count`] numbers.
    pub fn guard_rates(&mut self, point: Point<'_>, out: &mut [f64]) -> bool {
        let Some(rates) = self.program.outputs.guard_rates.clone() else {
            return false;
        };
        self.compute(Stage::GuardRates, &point);
        let mut place = 0;
        for (rate, guard) in rates.iter().zip(&self.program.guards) {
            let length = self.program.value(guard.value).extent.length();
            for (i, slot) in out[place..place + length].iter_mut().enumerate() {
                *slot = self.element(*rate, i);
            }
            place += length;
        }
        true
    }

    /// Computes the structural nonzeros of the Jacobian with this index.
    pub fn jacobian(&mut self, place: usize, point: Point<'_>, out: &mut [f64]) -> bool {
        if place >= self.program.outputs.jacobians.len() {
            return false;
        }
        self.compute(Stage::Jacobians, &point);
        self.copy_entries(&self.program.outputs.jacobians[place], out);
        true
    }

    /// Computes the structural nonzeros of the Jacobian with this index, whose only column is the derivative along a
    /// direction of state and inputs.
    pub fn compute_derivatives_along(
        &mut self,
        place: usize,
        point: Point<'_>,
        (state, inputs): (&[f64], &[f64]),
        out: &mut [f64],
    ) -> bool {
        self.set_argument(Argument::Direction, state, inputs);
        self.jacobian(place, point, out)
    }

    /// Computes the product of the Jacobian of the rates with a direction of state and inputs, one number for
    /// each state.
    pub fn jacobian_vector_product(
        &mut self,
        point: Point<'_>,
        (state, inputs): (&[f64], &[f64]),
        out: &mut [f64],
    ) -> bool {
        let Some(products) = self.program.outputs.products.clone() else {
            return false;
        };
        self.set_argument(Argument::Direction, state, inputs);
        self.compute(Stage::ForwardProduct, &point);
        let degrees = self.program.degrees_of_freedom();
        let (velocities, rest) = out.split_at_mut(degrees);
        let (accelerations, first_order) = rest.split_at_mut(degrees);
        for (slot, id) in first_order.iter_mut().zip(&products.forward_first_order) {
            *slot = self.element(*id, 0);
        }
        velocities.copy_from_slice(&state[degrees..2 * degrees]);
        let RowValues { scalars, modal } = products.forward;
        self.copy_rows(&scalars, &modal, accelerations);
        true
    }

    /// Computes the product of weights with the Jacobian of the rates by state and inputs.
    pub fn vector_jacobian_product(
        &mut self,
        point: Point<'_>,
        weights: &[f64],
        out: (&mut [f64], &mut [f64]),
    ) -> bool {
        self.compute_weighted(point, weights);
        let products = self.program.outputs.products.as_ref();
        products
            .map(|products| self.copy_weighted(products, weights, out))
            .is_some()
    }

    /// Computes the product of weights with the Jacobian of the rates by the independent parameters.
    pub fn vector_jacobian_product_by_parameters(
        &mut self,
        point: Point<'_>,
        weights: &[f64],
        out: &mut [f64],
    ) -> bool {
        self.compute_weighted(point, weights);
        let products = self.program.outputs.products.as_ref();
        products
            .map(|products| self.copy_weighted_by_parameters(products, out))
            .is_some()
    }

    /// Computes the products of weights with the Jacobians of the rates by state, inputs and independent parameters.
    pub fn weighted_gradient(
        &mut self,
        point: Point<'_>,
        weights: &[f64],
        (state, inputs, parameters): (&mut [f64], &mut [f64], &mut [f64]),
    ) -> bool {
        self.compute_weighted(point, weights);
        let Some(products) = &self.program.outputs.products else {
            return false;
        };
        self.copy_weighted(products, weights, (state, inputs));
        self.copy_weighted_by_parameters(products, parameters);
        true
    }

    fn compute_weighted(&mut self, point: Point<'_>, weights: &[f64]) {
        if self.program.outputs.products.is_some() {
            self.set_argument(Argument::Weights, weights, &[]);
            self.compute(Stage::ReverseProduct, &point);
        }
    }

    fn copy_weighted(
        &self,
        products: &Products<ValueId, RowValues>,
        weights: &[f64],
        (state, inputs): (&mut [f64], &mut [f64]),
    ) {
        let degrees = self.program.degrees_of_freedom();
        state.fill(0.0);
        inputs.fill(0.0);
        state[degrees..2 * degrees].copy_from_slice(&weights[..degrees]);
        for (variable, id) in &products.reverse {
            let place = self.program.variable_place(*variable);
            for i in 0..self.count(*variable) {
                let value = self.element(*id, i);
                match variable {
                    Variable::Input(_) => inputs[place] = value,
                    Variable::Rate(_) | Variable::ModeRates(_) => state[place + i] += value,
                    _ => state[place + i] = value,
                }
            }
        }
    }

    fn copy_weighted_by_parameters(
        &self,
        products: &Products<ValueId, RowValues>,
        out: &mut [f64],
    ) {
        out.fill(0.0);
        for entry in &products.by_parameters.entries {
            out[entry.column] = self.element(entry.value, 0);
        }
    }

    fn count(&self, variable: Variable) -> usize {
        match variable {
            Variable::ModeCoordinates(field) | Variable::ModeRates(field) => {
                self.program.fields[field].order
            }
            _ => 1,
        }
    }

    /// Copies the numbers of an argument to its values in memory.
    pub(super) fn set_argument(&mut self, argument: Argument, numbers: &[f64], inputs: &[f64]) {
        for (of, variable, id) in &self.arguments {
            if *of != argument {
                continue;
            }
            let from = match variable {
                Variable::Input(_) => inputs,
                _ => numbers,
            };
            let (place, start) = (
                self.program.variable_place(*variable),
                self.places.offset(*id),
            );
            let count = self.count(*variable);
            self.memory[start..start + count].copy_from_slice(&from[place..place + count]);
        }
    }

    fn copy_entries(&self, jacobian: &Jacobian<ValueId>, out: &mut [f64]) {
        for (entry, BlockPlace { start, width }) in jacobian.entries.iter().zip(jacobian.places()) {
            for row in 0..entry.rows {
                for column in 0..entry.width() {
                    out[start + width * row + column] = self.nonzero(entry, row, column);
                }
            }
        }
    }

    fn nonzero(&self, entry: &JacobianBlock<ValueId>, row: usize, column: usize) -> f64 {
        match self.program.value(entry.value).extent {
            Extent::Matrix(_, columns) => self.slice(entry.value)[row * columns + column],
            _ if entry.columns > 1 && !entry.diagonal => self.element(entry.value, column),
            _ => self.element(entry.value, row),
        }
    }
}
