//! Adapter that implements [`Outputs`] with the evaluator of a derived program.

use eomgen_codegen::program::BlockPlace;
use eomgen_codegen::program::Jacobian;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use nalgebra::DMatrix;

use crate::outputs::Outputs;
use crate::sampler::Sample;

/// Output functions of a derived variant with fixed parameters.
pub struct DerivedOutputs {
    evaluator: Evaluator,
}

impl DerivedOutputs {
    /// Creates the adapter; the evaluator must be prepared with the parameters to use.
    pub fn new(evaluator: Evaluator) -> Self {
        Self { evaluator }
    }

    fn degrees_of_freedom(&self) -> usize {
        self.evaluator.program().degrees_of_freedom()
    }
}

fn point(at: &Sample) -> Point<'_> {
    Point {
        t: at.time,
        state: &at.state,
        inputs: &at.inputs,
    }
}

impl Outputs for DerivedOutputs {
    fn names(&self) -> Vec<String> {
        let outputs = self.evaluator.program().outputs.kinds.iter();
        outputs.map(|output| output.name().to_owned()).collect()
    }

    fn parameter_names(&self) -> Vec<String> {
        let parameters = self.evaluator.program().parameters.iter();
        parameters
            .map(|known| known.quantity.name.clone())
            .collect()
    }

    fn bias_forces(&mut self, at: &Sample) -> Option<Vec<f64>> {
        let mut out = vec![f64::NAN; self.degrees_of_freedom()];
        self.evaluator
            .bias_forces(point(at), &mut out)
            .then_some(out)
    }

    fn inverse_dynamics(&mut self, at: &Sample, accelerations: &[f64]) -> Option<Vec<f64>> {
        let mut out = vec![f64::NAN; self.degrees_of_freedom()];
        let made = self
            .evaluator
            .inverse_dynamics(point(at), accelerations, &mut out);
        made.then_some(out)
    }

    fn guard_rates(&mut self, at: &Sample) -> Option<Vec<f64>> {
        let mut out = vec![f64::NAN; self.evaluator.guard_count()];
        self.evaluator
            .guard_rates(point(at), &mut out)
            .then_some(out)
    }

    fn jacobian(&mut self, name: &str, at: &Sample) -> Option<DMatrix<f64>> {
        let jacobians = &self.evaluator.program().outputs.jacobians;
        let place = jacobians.iter().position(|known| known.name == name)?;
        let jacobian = jacobians[place].clone();
        let mut nonzeros = vec![f64::NAN; jacobian.nonzeros()];
        let made = self.evaluator.jacobian(place, point(at), &mut nonzeros);
        made.then(|| dense(&jacobian, &nonzeros))
    }

    fn jacobian_vector_product(
        &mut self,
        at: &Sample,
        state: &[f64],
        inputs: &[f64],
    ) -> Option<Vec<f64>> {
        let mut out = vec![f64::NAN; at.state.len()];
        let direction = (state, inputs);
        let made = self
            .evaluator
            .jacobian_vector_product(point(at), direction, &mut out);
        made.then_some(out)
    }

    fn vector_jacobian_product(
        &mut self,
        at: &Sample,
        weights: &[f64],
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let mut state = vec![f64::NAN; at.state.len()];
        let mut inputs = vec![f64::NAN; at.inputs.len()];
        let out = (&mut state[..], &mut inputs[..]);
        let made = self
            .evaluator
            .vector_jacobian_product(point(at), weights, out);
        made.then_some((state, inputs))
    }

    fn vector_jacobian_product_by_parameters(
        &mut self,
        at: &Sample,
        weights: &[f64],
    ) -> Option<Vec<f64>> {
        let mut out = vec![f64::NAN; self.evaluator.program().parameters.len()];
        let made =
            self.evaluator
                .vector_jacobian_product_by_parameters(point(at), weights, &mut out);
        made.then_some(out)
    }
}

/// Returns the matrix with these structural nonzeros.
pub(crate) fn dense<N>(jacobian: &Jacobian<N>, nonzeros: &[f64]) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(jacobian.rows, jacobian.columns);
    for (entry, BlockPlace { start, width }) in jacobian.entries.iter().zip(jacobian.places()) {
        for row in 0..entry.rows {
            for place in 0..entry.width() {
                let column = if entry.diagonal { row } else { place };
                matrix[(entry.row + row, entry.column + column)] =
                    nonzeros[start + width * row + place];
            }
        }
    }
    matrix
}
