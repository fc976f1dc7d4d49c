//! Measured quantities as linear functions of the state, found by evaluating them.

use eomgen_codegen::program::evaluator::{Evaluator, Point};

use crate::model::measured_outputs::MeasuredOutputs;
use crate::thresholds;

/// Measured quantities as linear functions of the state.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearOutputs {
    /// A row per channel, a column per state.
    rows: Vec<Vec<f64>>,
    constant: Vec<f64>,
}

impl LinearOutputs {
    /// The quantities at an evaluator's parameters; none if they are not linear in the state, or
    /// depend on more than it. Inputs that are measured are not, nor accelerations: what changes a force changes them at once, and not by
    /// the state alone.
    pub(crate) fn of(outputs: &MeasuredOutputs, evaluator: &mut Evaluator) -> Option<Self> {
        if outputs.has_rates() || !outputs.inputs().is_empty() {
            return None;
        }
        let n = evaluator.program().states();
        let inputs = evaluator.program().inputs.len();
        let mut buffers = outputs.buffers();
        let mut quantities = |t: f64, state: &[f64], inputs: &[f64]| -> Vec<f64> {
            let mut values = Vec::with_capacity(outputs.count());
            let point = Point { t, state, inputs };
            outputs.append(evaluator, point, &mut buffers, &mut values);
            values
        };
        let constant = quantities(0.0, &vec![0.0; n], &vec![0.0; inputs]);
        let mut rows = vec![vec![0.0; n]; constant.len()];
        for column in 0..n {
            let mut state = vec![0.0; n];
            state[column] = 1.0;
            let values = quantities(0.0, &state, &vec![0.0; inputs]);
            for (row, (value, c)) in rows.iter_mut().zip(values.iter().zip(&constant)) {
                row[column] = value - c;
            }
        }
        let linear = Self { rows, constant };
        // Anywhere else, at another time and with other inputs, the sums must hold as well.
        for sign in [1.0, -0.3] {
            let state: Vec<f64> = (0..n).map(|k| sign * (0.7 + (k as f64).sin())).collect();
            let wanted = quantities(1.7, &state, &vec![0.9; inputs]);
            let mut found = Vec::new();
            linear.append(&state, &mut found);
            let mut pairs = wanted.iter().zip(&found);
            if !pairs.all(|(a, b)| (a - b).abs() <= thresholds::LINEAR * (a.abs() + 1e-12)) {
                return None;
            }
        }
        Some(linear)
    }

    /// Appends the quantities at a state.
    pub fn append(&self, state: &[f64], values: &mut Vec<f64>) {
        let pairs = self.rows.iter().zip(&self.constant);
        values.extend(pairs.map(|(row, c)| c + product(row, state)));
    }

    /// Appends the quantities' derivatives along a tangent vector.
    pub(crate) fn append_derivatives(&self, tangent: &[f64], values: &mut Vec<f64>) {
        values.extend(self.rows.iter().map(|row| product(row, tangent)));
    }
}

fn product(row: &[f64], vector: &[f64]) -> f64 {
    row.iter().zip(vector).map(|(a, b)| a * b).sum()
}
