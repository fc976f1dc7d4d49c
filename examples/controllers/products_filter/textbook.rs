//! Standard filter: Jacobians propagate the covariance matrix.

use crate::filter::Filter;
use crate::motion::{DISTURBANCE, STEP, STEPS, State, add_scaled, measured, runge_kutta_step};
use arm::{Coefficients, Inputs, RATES_BY_INPUTS, RATES_BY_STATE, STATES};

/// Computes the rates of the columns: each column is multiplied by the Jacobian by the state. The last column also
/// contains the torque disturbance.
fn by_jacobians(arm: &Coefficients) -> impl Fn(f64, &State, &Inputs, &[State]) -> Vec<State> {
    |t, state, inputs, columns| {
        let by_state = arm::rates_by_state(t, state, inputs, arm);
        let by_inputs = arm::rates_by_inputs(t, state, inputs, arm);
        let product = |column: &State| {
            let mut product = [0.0; STATES];
            for (k, nonzero) in by_state.iter().enumerate() {
                product[RATES_BY_STATE.rows[k]] += nonzero * column[RATES_BY_STATE.columns[k]];
            }
            product
        };
        let mut rates: Vec<State> = columns.iter().map(product).collect();
        if let Some(driven) = rates.last_mut() {
            for (k, nonzero) in by_inputs.iter().enumerate() {
                driven[RATES_BY_INPUTS.rows[k]] += DISTURBANCE * nonzero;
            }
        }
        rates
    }
}

/// Filter with a covariance matrix.
pub struct Textbook {
    pub estimate: State,
    pub covariance: Vec<State>,
}

impl Filter for Textbook {
    fn propagate(&mut self, arm: &Coefficients, t: f64) {
        // Columns of the transition matrix; the last column is the effect of the disturbance.
        let mut flow = vec![[0.0; STATES]; STATES + 1];
        for (k, column) in flow.iter_mut().take(STATES).enumerate() {
            column[k] = 1.0;
        }
        for count in 0..STEPS {
            let t = t + STEP * count as f64;
            runge_kutta_step(
                arm,
                t,
                0.0,
                &mut self.estimate,
                &mut flow,
                by_jacobians(arm),
            );
        }
        let pushed = flow[STATES];
        let times = |rows: &[State]| -> Vec<State> {
            let carried = |row: &State| {
                let add = |sum: State, (column, factor): (&State, &f64)| {
                    add_scaled(&sum, *factor, column)
                };
                flow.iter().zip(row).fold([0.0; STATES], add)
            };
            rows.iter().map(carried).collect()
        };
        let half = transposed(&times(&self.covariance));
        self.covariance = times(&half);
        for (row, part) in self.covariance.iter_mut().zip(pushed) {
            *row = add_scaled(row, part, &pushed);
        }
    }

    fn update(&mut self, arm: &Coefficients, t: f64, which: usize, value: f64, deviation: f64) {
        let direction: State =
            std::array::from_fn(|i| measured(arm, t, &self.covariance[i], which));
        let variance = measured(arm, t, &direction, which) + deviation * deviation;
        let missed = value - measured(arm, t, &self.estimate, which);
        self.estimate = add_scaled(&self.estimate, missed / variance, &direction);
        for (row, part) in self.covariance.iter_mut().zip(direction) {
            *row = add_scaled(row, -part / variance, &direction);
        }
    }

    fn estimate(&self) -> &State {
        &self.estimate
    }

    fn variance(&self, i: usize) -> f64 {
        self.covariance[i][i]
    }
}

fn transposed(rows: &[State]) -> Vec<State> {
    (0..STATES)
        .map(|j| std::array::from_fn(|i| rows[i][j]))
        .collect()
}
