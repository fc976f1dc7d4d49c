//! Filter with Jacobian-vector products. The covariance is S S'; each column of S is propagated by a product.

use crate::filter::Filter;
use crate::motion::{DISTURBANCE, STEP, STEPS, State, add_scaled, measured, runge_kutta_step};
use arm::{Coefficients, Inputs, STATES};

/// Scales of positions and rates for the selection of columns: 1 mm and 1 m/s.
const LARGE: [f64; 2] = [1e-3, 1.0];

/// Computes the rates of the columns, each by a product with the Jacobian. The last column also contains the torque
/// disturbance.
fn by_products(arm: &Coefficients) -> impl Fn(f64, &State, &Inputs, &[State]) -> Vec<State> {
    |t, state, inputs, columns| {
        let last = columns.len() - 1;
        let product = |(k, column)| {
            let push = Inputs {
                u: if k == last { DISTURBANCE } else { 0.0 },
            };
            arm::jacobian_vector_product(t, state, inputs, arm, column, &push)
        };
        columns.iter().enumerate().map(product).collect()
    }
}

/// Filter with the covariance S S'.
pub struct Products {
    pub estimate: State,
    pub columns: Vec<State>,
    /// Maximum number of columns.
    pub rank: usize,
}

impl Filter for Products {
    fn propagate(&mut self, arm: &Coefficients, t: f64) {
        self.columns.push([0.0; STATES]);
        for count in 0..STEPS {
            let t = t + STEP * count as f64;
            runge_kutta_step(
                arm,
                t,
                0.0,
                &mut self.estimate,
                &mut self.columns,
                by_products(arm),
            );
        }
        self.columns = largest(&self.columns, self.rank);
    }

    fn update(&mut self, arm: &Coefficients, t: f64, which: usize, value: f64, deviation: f64) {
        let seen: Vec<f64> = self
            .columns
            .iter()
            .map(|column| measured(arm, t, column, which))
            .collect();
        let variance = seen.iter().map(|seen| seen * seen).sum::<f64>() + deviation * deviation;
        let missed = value - measured(arm, t, &self.estimate, which);
        let mut direction = [0.0; STATES];
        for (column, seen) in self.columns.iter().zip(&seen) {
            direction = add_scaled(&direction, *seen, column);
        }
        self.estimate = add_scaled(&self.estimate, missed / variance, &direction);
        let shrink = 1.0 / (variance + deviation * variance.sqrt());
        for (column, seen) in self.columns.iter_mut().zip(&seen) {
            *column = add_scaled(column, -shrink * seen, &direction);
        }
    }

    fn estimate(&self) -> &State {
        &self.estimate
    }

    fn variance(&self, i: usize) -> f64 {
        self.columns
            .iter()
            .map(|column| column[i] * column[i])
            .sum()
    }
}

/// Returns at most `rank` orthogonal columns with the largest lengths: S times the eigenvectors of S' S, computed by
/// Jacobi rotations of the columns.
fn largest(columns: &[State], rank: usize) -> Vec<State> {
    let size = |i: usize| LARGE[usize::from(i >= STATES / 2)];
    let mut columns: Vec<State> = columns
        .iter()
        .map(|c| std::array::from_fn(|i| c[i] / size(i)))
        .collect();
    let product = |a: &State, b: &State| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for _ in 0..30 {
        let mut turned = false;
        for first in 0..columns.len() {
            for second in first + 1..columns.len() {
                let (a, b) = (columns[first], columns[second]);
                let (aa, bb, ab) = (product(&a, &a), product(&b, &b), product(&a, &b));
                if ab.abs() <= 1e-14 * (aa * bb).sqrt() {
                    continue;
                }
                turned = true;
                let (sine, cosine) = (0.5 * (2.0 * ab).atan2(aa - bb)).sin_cos();
                columns[first] = std::array::from_fn(|i| cosine * a[i] + sine * b[i]);
                columns[second] = std::array::from_fn(|i| cosine * b[i] - sine * a[i]);
            }
        }
        if !turned {
            break;
        }
    }
    columns.sort_by(|a, b| product(b, b).total_cmp(&product(a, a)));
    columns.truncate(rank);
    columns
        .iter()
        .map(|c| std::array::from_fn(|i| c[i] * size(i)))
        .collect()
}
