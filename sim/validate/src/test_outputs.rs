//! Hand-written outputs of the test model `SPRING`, with an optional error of 0.1 % in one number.

use super::outputs::Outputs;
use super::sampler::Sample;
use nalgebra::DMatrix;

pub(super) struct SpringOutputs(pub &'static str);

const M: f64 = 2.0;
const K: f64 = 300.0;
const B: f64 = 0.01;
const C: f64 = 5.0;

/// Returns stretch, side of the play (0 within it), rate and force.
fn spring_quantities(sample: &Sample) -> [f64; 4] {
    let (y, rate) = (sample.state[0], sample.state[1]);
    let side = if y.abs() > B { y.signum() } else { 0.0 };
    [y - y.clamp(-B, B), side, rate, sample.inputs[0]]
}

fn force(sample: &Sample) -> f64 {
    let [stretch, side, rate, pull] = spring_quantities(sample);
    pull - K * stretch - C * side.abs() * rate
}

impl SpringOutputs {
    /// Returns the numbers; if the fault is in this function, the last nonzero number is increased by 0.1 %.
    fn with_fault(&self, name: &str, mut numbers: Vec<f64>) -> Vec<f64> {
        let last = numbers.iter_mut().rev().find(|number| **number != 0.0);
        if let (true, Some(number)) = (self.0 == name, last) {
            *number *= 1.001;
        }
        numbers
    }

    fn rates_jacobian(&self, name: &str, at_: &Sample) -> DMatrix<f64> {
        let [stretch, side, rate, _] = spring_quantities(at_);
        let touching = side.abs();
        match name {
            "rates_by_state" => DMatrix::from_row_slice(
                2,
                2,
                &self.with_fault(name, vec![0.0, 1.0, -K * touching / M, -C * touching / M]),
            ),
            "rates_by_inputs" => {
                DMatrix::from_row_slice(2, 1, &self.with_fault(name, vec![0.0, 1.0 / M]))
            }
            "rates_by_parameters" => {
                let by_mass = -force(at_) / (M * M);
                let row = [by_mass, -stretch / M, K * side / M, -touching * rate / M];
                let numbers = [&[0.0; 4][..], &row].concat();
                DMatrix::from_row_slice(2, 4, &self.with_fault(name, numbers))
            }
            _ => self.observables_jacobian(name, at_),
        }
    }

    fn observables_jacobian(&self, name: &str, at_: &Sample) -> DMatrix<f64> {
        let [stretch, side, rate, pull] = spring_quantities(at_);
        let touching = side.abs();
        let (columns, numbers) = match name {
            "observables_by_state" => {
                let by_rate = pull - 2.0 * C * touching * rate;
                (2, vec![K * stretch, M * rate, 0.0, by_rate])
            }
            "observables_by_inputs" => (1, vec![0.0, rate]),
            _ => {
                let energy = [
                    0.5 * rate * rate,
                    0.5 * stretch * stretch,
                    -K * stretch * side,
                    0.0,
                ];
                let power = [0.0, 0.0, 0.0, -touching * rate * rate];
                (4, [energy, power].concat())
            }
        };
        DMatrix::from_row_slice(2, columns, &self.with_fault(name, numbers))
    }

    fn weighted_rows(&self, name: &str, at_: &Sample, weights: &[f64]) -> Vec<f64> {
        let jacobian = SpringOutputs("").rates_jacobian(name, at_);
        let weights = DMatrix::from_row_slice(1, 2, weights);
        (weights * jacobian).as_slice().to_vec()
    }
}

impl Outputs for SpringOutputs {
    fn names(&self) -> Vec<String> {
        let names = [
            "bias_forces",
            "inverse_dynamics",
            "guard_rates",
            "jacobians",
            "products",
        ];
        names.map(str::to_owned).to_vec()
    }

    fn parameter_names(&self) -> Vec<String> {
        ["m", "k", "b", "c"].map(str::to_owned).to_vec()
    }

    fn bias_forces(&mut self, at: &Sample) -> Option<Vec<f64>> {
        Some(self.with_fault("bias_forces", vec![-force(at)]))
    }

    fn inverse_dynamics(&mut self, at: &Sample, accelerations: &[f64]) -> Option<Vec<f64>> {
        let missing = M * accelerations[0] - force(at);
        Some(self.with_fault("inverse_dynamics", vec![missing]))
    }

    fn guard_rates(&mut self, at: &Sample) -> Option<Vec<f64>> {
        Some(self.with_fault("guard_rates", vec![at.state[1]; 2]))
    }

    fn jacobian(&mut self, name: &str, at: &Sample) -> Option<DMatrix<f64>> {
        let mut found = self.rates_jacobian(name, at);
        if self.0 == "not a number at rest" && at.state[1] == 0.0 {
            found.fill(f64::NAN);
        }
        Some(found)
    }

    fn jacobian_vector_product(
        &mut self,
        at: &Sample,
        state: &[f64],
        inputs: &[f64],
    ) -> Option<Vec<f64>> {
        let right = SpringOutputs("");
        let by_state =
            right.rates_jacobian("rates_by_state", at) * DMatrix::from_row_slice(2, 1, state);
        let by_inputs = right.rates_jacobian("rates_by_inputs", at) * inputs[0];
        let product = (by_state + by_inputs).as_slice().to_vec();
        Some(self.with_fault("jacobian_vector_product", product))
    }

    fn vector_jacobian_product(
        &mut self,
        at: &Sample,
        weights: &[f64],
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let by_state = self.weighted_rows("rates_by_state", at, weights);
        let by_inputs = self.weighted_rows("rates_by_inputs", at, weights);
        Some((
            self.with_fault("vector_jacobian_product", by_state),
            by_inputs,
        ))
    }

    fn vector_jacobian_product_by_parameters(
        &mut self,
        at: &Sample,
        weights: &[f64],
    ) -> Option<Vec<f64>> {
        let product = self.weighted_rows("rates_by_parameters", at, weights);
        Some(self.with_fault("vector_jacobian_product_by_parameters", product))
    }
}
