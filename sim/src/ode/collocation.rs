//! One step of the Radau IIA method: its three stages by Newton's method, the error estimate and the
//! collocation polynomial (Hairer and Wanner, "Solving Ordinary Differential Equations II", section IV.8).
//! `radau` selects the step sizes and accepts the steps.
//!
//! Z are the differences of the stages from the start, A the coefficients of the method and h the step size.
//! The stages solve A^-1 Z / h = F(Z). The transformation W = T^-1 Z turns A^-1 into one real eigenvalue and a
//! complex pair. Newton's method then solves one real and one complex linear system of the size of the state,
//! instead of one system of three times this size.

use nalgebra::{Complex, DMatrix, DVector, Dyn, LU};

use super::magnitudes::Magnitudes;
use super::stepper::Point;
use super::system::System;
use super::watch::WatchedSystem;

/// Maximum number of Newton iterations in a step.
pub const MAX_NEWTON_ITERATIONS: u32 = 7;

/// Tolerance of the stages, as a fraction of the tolerance of the step.
const STAGE_TOLERANCE_FRACTION: f64 = 0.03;

/// Smallest tolerance of the stages, in units of the last place.
const MIN_STAGE_ROUNDINGS: f64 = 10.0;

/// Iterations end at a change below this fraction of the tolerance of the stages.
const SMALL_CHANGE_FRACTION: f64 = 0.3;

/// Ratio of successive changes above which the iteration counts as divergent.
const MAX_CONTRACTION: f64 = 0.99;

/// Real eigenvalue of A^-1.
const REAL_EIGENVALUE: f64 = 3.637_834_252_744_496;

/// Real and imaginary part of the complex pair of eigenvalues of A^-1.
const COMPLEX_EIGENVALUE: (f64, f64) = (2.681_082_873_627_752_3, 3.050_430_199_247_410_5);

/// Eigenvectors of A in columns; real and imaginary part for the complex pair.
const T: [[f64; 3]; 3] = [
    [
        0.091_232_394_870_892_94,
        -0.141_255_295_020_954_2,
        -0.030_029_194_105_147_424,
    ],
    [
        0.241_717_932_707_107,
        0.204_129_352_293_799_93,
        0.382_942_112_757_261_9,
    ],
    [0.966_048_182_615_093, 1.0, 0.0],
];

/// Inverse of T.
const T_INVERSE: [[f64; 3]; 3] = [
    [
        4.325_579_890_063_155,
        0.339_199_251_815_809_84,
        0.541_770_539_935_874_9,
    ],
    [
        -4.178_718_591_551_905,
        -0.327_682_820_761_062_4,
        0.476_623_554_500_550_44,
    ],
    [
        -0.502_872_634_945_786_8,
        2.571_926_949_855_605,
        -0.596_039_204_828_224_9,
    ],
];

/// Returns the times of the stages, as fractions of the step.
fn compute_nodes() -> [f64; 3] {
    let root = 6.0_f64.sqrt();
    [(4.0 - root) / 10.0, (4.0 + root) / 10.0, 1.0]
}

/// Returns the weights of the stages in the error estimate.
fn compute_error_weights() -> [f64; 3] {
    let root = 6.0_f64.sqrt();
    [
        -(13.0 + 7.0 * root) / 3.0,
        (-13.0 + 7.0 * root) / 3.0,
        -1.0 / 3.0,
    ]
}

/// LU factors of the linear systems for one step size and one Jacobian.
pub struct LinearFactors {
    /// Step size, s.
    pub length: f64,
    real: LU<f64, Dyn, Dyn>,
    pair: LU<Complex<f64>, Dyn, Dyn>,
}

impl LinearFactors {
    /// Factorises the linear systems for a Jacobian and steps of `length` s.
    pub fn new(jacobian: &DMatrix<f64>, length: f64) -> Self {
        let states = jacobian.nrows();
        let mut real = -jacobian;
        let mut pair = jacobian.map(|entry| Complex::new(-entry, 0.0));
        for index in 0..states {
            real[(index, index)] += REAL_EIGENVALUE / length;
            pair[(index, index)] +=
                Complex::new(COMPLEX_EIGENVALUE.0, COMPLEX_EIGENVALUE.1) / length;
        }
        Self {
            length,
            real: real.lu(),
            pair: pair.lu(),
        }
    }
}

/// Stages of a step, as differences from its start.
#[derive(Clone)]
pub struct Stages {
    z: [DVector<f64>; 3],
    /// Length of the step, s.
    length: f64,
    /// Number of Newton iterations.
    pub iterations: u32,
    /// Ratio of the last two changes. It measures the accuracy of the Jacobian.
    pub contraction: f64,
}

impl Stages {
    /// Solves the stages of a step from `start` with these `factors`. The initial guess extrapolates the
    /// collocation polynomial of the step `before`. Returns `None` if Newton's method does not converge.
    pub fn solve<S: System + ?Sized>(
        watched: &WatchedSystem<'_, S>,
        start: &Point,
        factors: &LinearFactors,
        before: Option<&Self>,
        magnitudes: &Magnitudes,
    ) -> Option<Self> {
        let (length, states) = (factors.length, start.y.len());
        let mut z = match before {
            Some(before) => compute_nodes().map(|node| before.extrapolate(node * length)),
            None => [(); 3].map(|()| DVector::zeros(states)),
        };
        let mut w = transform(&T_INVERSE, &z);
        let tolerance = magnitudes.tolerance();
        let enough = STAGE_TOLERANCE_FRACTION.min(tolerance.sqrt());
        let enough = enough.max(MIN_STAGE_ROUNDINGS * f64::EPSILON / tolerance);
        let (mut last_change, mut contraction) = (0.0, 0.0);
        for iterations in 1..=MAX_NEWTON_ITERATIONS {
            let rates = evaluate_stage_rates(watched, start, length, &z);
            let Some(change) = solve_newton_change(factors, &w, &transform(&T_INVERSE, &rates))
            else {
                break;
            };
            let sizes = change.each_ref().map(|part| {
                let size = magnitudes.norm(part.iter().copied(), &start.y);
                size * size
            });
            let size = (sizes.iter().sum::<f64>() / 3.0).sqrt();
            if !size.is_finite() {
                break;
            }
            for (w, change) in w.iter_mut().zip(&change) {
                *w += change;
            }
            z = transform(&T, &w);
            let is_first = iterations == 1;
            if !is_first {
                contraction = size / last_change;
            }
            // After such a small change, further changes are negligible, whatever their ratio.
            let is_small = size <= SMALL_CHANGE_FRACTION * enough;
            if !is_small && contraction >= MAX_CONTRACTION {
                break;
            }
            // After one change, the remaining error is unknown.
            let left = contraction / (1.0 - contraction) * size;
            if is_small || (!is_first && left <= enough) {
                return Some(Self {
                    z,
                    length,
                    iterations,
                    contraction,
                });
            }
            let more = (MAX_NEWTON_ITERATIONS - iterations) as i32;
            if !is_first && left * contraction.powi(more - 1) > enough {
                break;
            }
            last_change = size;
        }
        None
    }

    /// Returns the state at the end of the step.
    pub fn end_state(&self, start: &[f64]) -> Vec<f64> {
        start.iter().zip(&self.z[2]).map(|(y, z)| y + z).collect()
    }

    /// Returns the state at a time `after` the start of the step, s, from the polynomial of order 3
    /// through the start and the stages.
    pub fn interpolate(&self, start: &[f64], after: f64) -> Vec<f64> {
        let difference = self.interpolate_difference(after / self.length);
        start.iter().zip(&difference).map(|(y, z)| y + z).collect()
    }

    /// Returns the difference from the end of the step, extrapolated to `after` s beyond it.
    fn extrapolate(&self, after: f64) -> DVector<f64> {
        self.interpolate_difference(1.0 + after / self.length) - &self.z[2]
    }

    /// Returns the difference from the start at a fraction of the step: a Lagrange polynomial, zero at 0.
    fn interpolate_difference(&self, part: f64) -> DVector<f64> {
        let nodes = compute_nodes();
        let mut sum = DVector::zeros(self.z[0].len());
        for (index, z) in self.z.iter().enumerate() {
            let mut factor = part / nodes[index];
            for (other, node) in nodes.iter().enumerate() {
                if other != index {
                    factor *= (part - node) / (nodes[index] - node);
                }
            }
            sum.axpy(factor, z, 1.0);
        }
        sum
    }

    /// Returns the estimated error of interpolated states relative to the allowed error, from the change of the
    /// third derivative since the step `before`. The error estimate of the step ignores fast decaying
    /// components, which are correct at the ends of steps of any length.
    pub fn estimate_interior_error(
        &self,
        before: &Self,
        start: &Point,
        magnitudes: &Magnitudes,
    ) -> f64 {
        let apart = 0.5 * (self.length + before.length);
        let change = (self.compute_third_derivative() - before.compute_third_derivative()) / apart;
        let error = change * (MAX_NODE_POLYNOMIAL / 24.0 * self.length.powi(4));
        magnitudes.norm(error.iter().copied(), &start.y)
    }

    /// Returns the third derivative of the polynomial through the start and the stages.
    fn compute_third_derivative(&self) -> DVector<f64> {
        let nodes = compute_nodes();
        let mut sum = DVector::zeros(self.z[0].len());
        for (index, z) in self.z.iter().enumerate() {
            let others = (0..3).filter(|other| *other != index);
            let product: f64 = others.map(|other| nodes[index] - nodes[other]).product();
            sum.axpy(6.0 / (nodes[index] * product * self.length.powi(3)), z, 1.0);
        }
        sum
    }

    /// Returns the estimated error of the step relative to the allowed error. `rates` are the rates at the
    /// start. If `is_doubted`, as for a first step or a step after a rejection, the estimate is filtered a
    /// second time with rates beside the start.
    pub fn estimate_error<S: System + ?Sized>(
        &self,
        watched: &WatchedSystem<'_, S>,
        start: &Point,
        rates: &[f64],
        (factors, magnitudes): (&LinearFactors, &Magnitudes),
        is_doubted: bool,
    ) -> f64 {
        let mut combined = DVector::zeros(start.y.len());
        for (weight, z) in compute_error_weights().into_iter().zip(&self.z) {
            combined.axpy(weight / self.length, z, 1.0);
        }
        let filtered = |rates: &[f64]| {
            let right = DVector::from_column_slice(rates) + &combined;
            let error = factors.real.solve(&right)?;
            let norm = magnitudes.norm(error.iter().copied(), &start.y);
            Some((error, norm))
        };
        let Some((error, norm)) = filtered(rates) else {
            return f64::INFINITY;
        };
        if norm < 1.0 || !is_doubted {
            return norm;
        }
        let beside: Vec<f64> = start.y.iter().zip(&error).map(|(y, e)| y + e).collect();
        let mut rates = vec![0.0; beside.len()];
        watched.rates(start.t, &beside, &mut rates);
        filtered(&rates).map_or(f64::INFINITY, |(_, norm)| norm)
    }
}

/// Maximum of |s (s - c_1) (s - c_2) (s - 1)| for 0 < s < 1, where c_1, c_2 and 1 are the nodes. The
/// interpolation error is proportional to it.
const MAX_NODE_POLYNOMIAL: f64 = 0.01826;

/// Returns the rates at the stages.
fn evaluate_stage_rates<S: System + ?Sized>(
    watched: &WatchedSystem<'_, S>,
    start: &Point,
    length: f64,
    z: &[DVector<f64>; 3],
) -> [DVector<f64>; 3] {
    let nodes = compute_nodes();
    let mut rates = vec![0.0; start.y.len()];
    std::array::from_fn(|stage| {
        let y: Vec<f64> = start.y.iter().zip(&z[stage]).map(|(y, z)| y + z).collect();
        watched.rates(start.t + nodes[stage] * length, &y, &mut rates);
        DVector::from_column_slice(&rates)
    })
}

/// Returns the Newton change of W, given W and T^-1 F; `None` if a linear system is singular.
fn solve_newton_change(
    factors: &LinearFactors,
    w: &[DVector<f64>; 3],
    rates: &[DVector<f64>; 3],
) -> Option<[DVector<f64>; 3]> {
    let h = factors.length;
    let first = factors
        .real
        .solve(&(&rates[0] - &w[0] * (REAL_EIGENVALUE / h)))?;
    let eigenvalue = Complex::new(COMPLEX_EIGENVALUE.0, COMPLEX_EIGENVALUE.1) / h;
    let pair = DVector::from_fn(w[1].len(), |index, _| {
        let of_rates = Complex::new(rates[1][index], rates[2][index]);
        of_rates - eigenvalue * Complex::new(w[1][index], w[2][index])
    });
    let pair = factors.pair.solve(&pair)?;
    Some([
        first,
        pair.map(|entry| entry.re),
        pair.map(|entry| entry.im),
    ])
}

/// Returns the product of a matrix with three vectors.
fn transform(matrix: &[[f64; 3]; 3], vectors: &[DVector<f64>; 3]) -> [DVector<f64>; 3] {
    matrix.map(|row| {
        let mut sum = DVector::zeros(vectors[0].len());
        for (factor, vector) in row.into_iter().zip(vectors) {
            sum.axpy(factor, vector, 1.0);
        }
        sum
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Vector3};

    use super::*;

    /// Computes the coefficients of the method from its nodes: integrals of the Lagrange polynomials.
    fn compute_coefficients() -> Matrix3<f64> {
        let nodes = compute_nodes();
        let powers = Matrix3::from_fn(|row, column| nodes[row].powi(column as i32));
        let integrals = Matrix3::from_fn(|row, column| {
            nodes[row].powi(column as i32 + 1) / f64::from(column as u32 + 1)
        });
        integrals * powers.try_inverse().expect("distinct nodes")
    }

    #[test]
    fn transform_separates_real_and_complex_eigenvalues() {
        let t = Matrix3::from_fn(|row, column| T[row][column]);
        let inverse = Matrix3::from_fn(|row, column| T_INVERSE[row][column]);
        assert!((t * inverse - Matrix3::identity()).abs().max() < 1e-14);
        let of_inverse = compute_coefficients().try_inverse().expect("not singular");
        let (a, b) = COMPLEX_EIGENVALUE;
        let expected = Matrix3::new(REAL_EIGENVALUE, 0.0, 0.0, 0.0, a, -b, 0.0, b, a);
        assert!((inverse * of_inverse * t - expected).abs().max() < 1e-13);
    }

    #[test]
    fn interpolation_error_constant_is_its_maximum() {
        let [a, b, c] = compute_nodes();
        let values = (0..=10_000).map(|i| {
            let s = f64::from(i) / 1e4;
            (s * (s - a) * (s - b) * (s - c)).abs()
        });
        let largest = values.fold(0.0, f64::max);
        assert!(
            (largest / MAX_NODE_POLYNOMIAL - 1.0).abs() < 0.01,
            "{largest}"
        );
    }

    #[test]
    fn error_estimate_vanishes_for_cubic_polynomials() {
        // For y = s^p and h = 1, the rates at the start are 0 if p > 1. The estimate compares the step with a
        // formula of order 3.
        let weights = Vector3::from(compute_error_weights());
        for power in 2..=3 {
            let stages = Vector3::from(compute_nodes()).map(|node| node.powi(power));
            assert!(weights.dot(&stages).abs() < 1e-14, "{power}");
        }
    }
}
