//! Given motion: the inputs measured by channels follow from inverse dynamics. No equation is
//! integrated.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use nalgebra::{DMatrix, DVector};

use crate::model::measured_outputs::{MeasuredInput, MeasuredOutputs};
use crate::thresholds;

/// Inverse dynamics of a model along motions from records. A row of a record contains its inputs,
/// all coordinates, all rates and all second derivatives, in this order.
pub(crate) struct GivenMotion {
    /// Number of inputs.
    inputs: usize,
    degrees: usize,
    /// Inputs that are computed, one for each degree of freedom.
    required: Vec<MeasuredInput>,
    /// Buffer for the rates of the state.
    rates: Vec<f64>,
}

impl GivenMotion {
    /// Creates the inverse dynamics of a model with measured inputs; `None` if the records do not
    /// contain all states.
    pub fn from_measured_inputs(evaluator: &Evaluator, measured: &MeasuredOutputs) -> Option<Self> {
        let program = evaluator.program();
        let (states, degrees) = (program.states(), program.degrees_of_freedom());
        let required = measured.inputs().to_vec();
        (states == 2 * degrees && required.len() == degrees).then(|| Self {
            inputs: program.inputs.len(),
            degrees,
            required,
            rates: vec![0.0; states],
        })
    }

    /// Returns the state in a row of a record; `None` if the row belongs to another model.
    pub fn state_of_row<'r>(&self, row: &'r [f64]) -> Option<&'r [f64]> {
        let is_own = row.len() == self.inputs + 3 * self.degrees;
        is_own.then(|| &row[self.inputs..self.inputs + 2 * self.degrees])
    }

    /// Returns the inputs for a row of a record. The computed inputs give the recorded second
    /// rates; `None` if there are no such inputs. Second rates are usually linear in the inputs, so
    /// one Newton step suffices.
    pub fn solve_inputs(
        &mut self,
        evaluator: &mut Evaluator,
        t: f64,
        row: &[f64],
    ) -> Option<Vec<f64>> {
        let state = self.state_of_row(row)?;
        let given = &row[self.inputs + 2 * self.degrees..];
        let mut inputs = row[..self.inputs].to_vec();
        for MeasuredInput { index, .. } in &self.required {
            inputs[*index] = 0.0;
        }
        let mut at = |inputs: &[f64]| -> DVector<f64> {
            let point = Point { t, state, inputs };
            evaluator.rates(point, &mut self.rates);
            DVector::from_column_slice(&self.rates[self.degrees..])
        };
        let wanted = DVector::from_column_slice(given);
        let mut present = at(&inputs);
        for _ in 0..thresholds::MAX_INVERSE_DYNAMICS_STEPS {
            let mut columns = Vec::with_capacity(self.degrees);
            for MeasuredInput { index, noise } in &self.required {
                let here = inputs[*index];
                let size = noise.max(thresholds::MIN_INVERSE_DYNAMICS_QUOTIENT * here.abs());
                inputs[*index] = here + size;
                columns.push((at(&inputs) - &present) / size);
                inputs[*index] = here;
            }
            let left = &wanted - &present;
            let matrix = DMatrix::from_columns(&columns);
            let change = matrix.clone().lu().solve(&left)?;
            for (input, change) in self.required.iter().zip(change.iter()) {
                inputs[input.index] += change;
            }
            present = at(&inputs);
            // The tolerance includes terms that nearly cancel, because their rounding remains. Each
            // second derivative has its own scale, because units differ.
            let applied = self.required.iter().map(|input| inputs[input.index].abs());
            let applied = DVector::from_iterator(self.required.len(), applied);
            let sizes = wanted.abs() + left.abs() + matrix.abs() * applied;
            let missed = (&wanted - &present).abs();
            let mut pairs = missed.iter().zip(&sizes);
            if pairs.all(|(missed, size)| *missed <= thresholds::MAX_INVERSE_DYNAMICS_ERROR * size)
            {
                return Some(inputs);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::estimation_model::EstimationModel;
    use eomgen_records::dataset::{Channel, Quantity, TransducerPriors};

    /// Two joints coupled by a gear; both motors act on the second joint.
    const ARM: &str = r#"[model]
name = "arm"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.4, unit = "m" }
k = { value = 3, unit = "N*m" }
[coordinates]
p = { unit = "rad" }
q = { unit = "rad" }
[inputs]
u = { unit = "N*m" }
v = { unit = "N*m" }
[kinetic]
turning = "1/2*m*l^2*((2 + cos(q))*dot(p)^2 + dot(p)*dot(q) + dot(q)^2)"
[potential]
weight = "-k*cos(p + q)"
[forces]
first = { on = "p + 2*q", value = "u" }
second = { on = "q", value = "v*(2 + sin(v/k)/2)" }
"#;

    fn channel(name: &str, input: usize) -> Channel {
        Channel {
            name: name.to_owned(),
            observable: name.to_owned(),
            quantity: Quantity::Input(input),
            unit: "N*m".to_owned(),
            noise: 0.1,
            priors: TransducerPriors::default(),
        }
    }

    #[test]
    fn inverse_dynamics_recovers_inputs() {
        let channels = [channel("v", 1), channel("u", 0)];
        let model =
            EstimationModel::derive_equations(ARM, "arm", None, &channels).expect("a model");
        let mut evaluator = model.create_evaluator(&model.values);
        let mut given =
            GivenMotion::from_measured_inputs(&evaluator, &model.measured).expect("a motion");
        for turn in 0..50 {
            let number = |k: i32| 2.0 * f64::from(k + 7 * turn).sin();
            let inputs = [number(1), number(2)];
            let state = [number(3), number(4), number(5), number(6)];
            let mut rates = [0.0; 4];
            let point = Point {
                t: 0.0,
                state: &state,
                inputs: &inputs,
            };
            evaluator.rates(point, &mut rates);
            let row = [&[9.0, 9.0], &state[..], &rates[2..]].concat();
            let found = given
                .solve_inputs(&mut evaluator, 0.0, &row)
                .expect("inputs");
            for (found, wanted) in found.iter().zip(inputs) {
                assert!((found - wanted).abs() < 1e-7, "{found} {wanted}");
            }
        }
    }

    #[test]
    fn model_with_unrecorded_states_is_rejected() {
        let late = ARM.replace("value = \"u\"", "value = \"F\"")
            + "[states]\nF = { unit = \"N*m\", rate = \"(u - F)*w\" }\n";
        let late = late.replace("k = {", "w = { value = 3, unit = \"1/s\" }\nk = {");
        let channels = [channel("v", 1), channel("u", 0)];
        let model =
            EstimationModel::derive_equations(&late, "arm", None, &channels).expect("a model");
        assert!(
            GivenMotion::from_measured_inputs(
                &model.create_evaluator(&model.values),
                &model.measured
            )
            .is_none()
        );
    }
}
