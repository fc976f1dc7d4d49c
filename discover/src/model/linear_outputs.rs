//! Measured outputs as linear functions of the state.

use eomgen_codegen::program::evaluator::{Evaluator, Point};

use crate::model::affine_values::are_affine;
use crate::model::measured_outputs::MeasuredOutputs;

/// Measured outputs as linear functions of the state.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearOutputs {
    /// Coefficients: one row per channel, one column per state.
    rows: Vec<Vec<f64>>,
    constant: Vec<f64>,
}

impl LinearOutputs {
    /// Returns the outputs for the parameters of an evaluator; `None` if they are nonlinear or
    /// depend on more than the state. Measured inputs and accelerations are excluded, because
    /// forces change them immediately.
    pub(crate) fn linearise_outputs(
        outputs: &MeasuredOutputs,
        evaluator: &mut Evaluator,
    ) -> Option<Self> {
        if outputs.has_rates() || !outputs.inputs().is_empty() {
            return None;
        }
        if !are_affine(
            evaluator.program(),
            &outputs.observable_values(evaluator.program()),
        ) {
            return None;
        }
        let n = evaluator.program().states();
        let inputs = vec![0.0; evaluator.program().inputs.len()];
        let mut buffers = outputs.create_buffers();
        let mut quantities = |state: &[f64]| -> Vec<f64> {
            let mut values = Vec::with_capacity(outputs.count());
            let (t, inputs) = (0.0, &inputs[..]);
            let point = Point { t, state, inputs };
            outputs.append(evaluator, point, &mut buffers, &mut values);
            values
        };
        let mut state = vec![0.0; n];
        let constant = quantities(&state);
        let mut rows = vec![vec![0.0; n]; constant.len()];
        // For such a large state, the constant is lost to rounding. A power of two keeps the factor
        // exact.
        let away = 2f64.powi(300);
        for column in 0..n {
            state[column] = away;
            let values = quantities(&state);
            state[column] = 0.0;
            for (row, (value, c)) in rows.iter_mut().zip(values.iter().zip(&constant)) {
                row[column] = (value - c) / away;
            }
        }
        Some(Self { rows, constant })
    }

    /// Appends the outputs at a state.
    pub fn append(&self, state: &[f64], values: &mut Vec<f64>) {
        let pairs = self.rows.iter().zip(&self.constant);
        values.extend(pairs.map(|(row, c)| c + product(row, state)));
    }

    /// Appends the derivatives of the outputs along a tangent vector.
    pub(crate) fn append_derivatives(&self, tangent: &[f64], values: &mut Vec<f64>) {
        values.extend(self.rows.iter().map(|row| product(row, tangent)));
    }
}

fn product(row: &[f64], vector: &[f64]) -> f64 {
    row.iter().zip(vector).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::LinearOutputs;
    use crate::model::estimation_model::EstimationModel;
    use eomgen_records::dataset::{Channel, Quantity, TransducerPriors};

    /// Hydraulic cylinder whose flow decreases with its pressure.
    const CYLINDER: &str = r#"[model]
name = "cylinder"
[parameters]
m = { value = 60, unit = "kg" }
A = { value = 8e-4, unit = "m^2" }
E = { value = 5e12, unit = "Pa/m^3" }
p_s = { value = 1e7, unit = "Pa" }
x_0 = { value = 2, unit = "m" }
[coordinates]
x = { unit = "m" }
[states]
p = { unit = "Pa", rate = "-E*A*dot(x)" }
[kinetic]
load = "1/2*m*dot(x)^2"
[forces]
pressure = { on = "x", value = "A*p" }
[observables]
force = "A*p"
place = "x_0 + x/3"
flow = "sqrt(1 - p/p_s)"
"#;

    fn outputs(observable: usize) -> Option<LinearOutputs> {
        let channel = Channel {
            name: "c".to_owned(),
            observable: "c".to_owned(),
            quantity: Quantity::Observable(observable),
            unit: "1".to_owned(),
            noise: 1e-3,
            priors: TransducerPriors::default(),
        };
        let model = EstimationModel::derive_equations(CYLINDER, "cylinder", None, &[channel]);
        let model = model.expect("a model");
        model.derive_linear_outputs(&model.values)
    }

    #[test]
    fn factors_are_exact_with_a_large_constant() {
        let place = outputs(1).expect("linear");
        assert_eq!(place.constant, [2.0]);
        assert_eq!(place.rows, [[1.0 / 3.0, 0.0, 0.0]]);
    }

    #[test]
    fn square_root_of_pressure_is_not_linear() {
        assert_eq!(outputs(2), None);
    }
}
