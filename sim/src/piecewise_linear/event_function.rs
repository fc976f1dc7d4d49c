//! Event function: a linear function of the motion within one regime, and the limits between which it stays
//! while the regime lasts. It is prepared such that value and time derivatives take a few products per mode.

use eomgen_codegen::program::affine::AffineRows;
use nalgebra::{Complex, DVector};

use super::forced_integrals::factorial;
use super::integrals::{Integrals, Polynomial};
use super::modes::Modes;
use super::regime::Cluster;
use super::simd_vectors::{SimdVector, SplitComplex, pack};

/// Function of state, inputs and sinusoids: coefficients as in [`AffineRows`].
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Linear {
    pub state: DVector<f64>,
    pub inputs: Vec<f64>,
    pub sines: Vec<f64>,
    pub cosines: Vec<f64>,
    pub constant: f64,
}

impl Linear {
    /// Returns the function in row `row`.
    pub fn row(rows: &AffineRows, row: usize) -> Self {
        let part = |values: &[f64]| {
            let width = values.len().checked_div(rows.rows).unwrap_or(0);
            values[row * width..(row + 1) * width].to_vec()
        };
        Self {
            state: DVector::from_vec(part(&rows.state)),
            inputs: part(&rows.inputs),
            sines: part(&rows.sines),
            cosines: part(&rows.cosines),
            constant: rows.constant[row],
        }
    }

    /// Returns the value at a state, with the sines and cosines of the phases.
    pub fn value(&self, state: &[f64], inputs: &[f64], phases: &[Complex<f64>]) -> f64 {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut value = dot(self.state.as_slice(), state) + dot(&self.inputs, inputs);
        for (index, phase) in phases.iter().enumerate() {
            value += self.sines[index] * phase.im + self.cosines[index] * phase.re;
        }
        value + self.constant
    }

    /// Returns the sum of the magnitudes of the terms of the value.
    pub fn size(&self, state: &[f64], inputs: &[f64], phases: &[Complex<f64>]) -> f64 {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a * b).abs()).sum::<f64>();
        let sinusoids = self.sines.iter().zip(&self.cosines).zip(phases);
        let sinusoids = sinusoids
            .map(|((sine, cosine), phase)| (sine * phase.im).abs() + (cosine * phase.re).abs());
        let moving = dot(self.state.as_slice(), state) + dot(&self.inputs, inputs);
        moving + sinusoids.sum::<f64>() + self.constant.abs()
    }

    /// Returns true if the function does not depend on the state or time.
    pub fn is_still(&self) -> bool {
        let moving = self.state.iter().chain(&self.sines).chain(&self.cosines);
        moving.copied().all(|factor| factor == 0.0)
    }

    /// Returns the coefficients of all variables.
    pub fn coefficients(&self) -> impl Iterator<Item = f64> + '_ {
        let driven = self.inputs.iter().chain(&self.sines).chain(&self.cosines);
        self.state.iter().chain(driven).copied()
    }
}

/// Limits of a function within a regime.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    /// Family of parallel surfaces that the function belongs to.
    pub family: usize,
    /// Lower limit: the regime lasts while the function is above it.
    pub low: f64,
    /// Upper limit: the regime lasts while the function is below it.
    pub high: f64,
}

impl Limits {
    /// Returns infinite limits.
    pub fn none(family: usize) -> Self {
        Self {
            family,
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        }
    }
}

/// Factors of one mode in a function, in the layout of SIMD vectors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    /// Real parts of the factors in the derivatives of order 0 to 3.
    pub re: SimdVector,
    /// Imaginary parts of the factors in the derivatives of order 0 to 3.
    pub im: SimdVector,
    /// Magnitudes of the factors in the orders 0, 1, 4 and 2.
    pub size: SimdVector,
}

/// Factors of the modes of one SIMD vector in the value of a function.
#[derive(Clone, Copy, Debug)]
pub(super) struct ValueWeights {
    pub re: SimdVector,
    pub im: SimdVector,
    pub size: SimdVector,
}

/// Function prepared for one regime.
#[derive(Clone, Debug)]
pub(super) struct EventFunction {
    pub linear: Linear,
    pub limits: Limits,
    /// Factors of each mode.
    pub weights: Vec<Weights>,
    /// Factors of each SIMD vector of modes in the value.
    pub value_weights: Vec<ValueWeights>,
    /// Contribution of the integrals.
    pub polynomial: Polynomial,
    /// row columns N^k of each cluster.
    pub cluster_powers: Vec<Vec<DVector<Complex<f64>>>>,
    /// Indices of the initial values that the function depends on, with their factors.
    felt: Vec<(usize, f64)>,
    /// Sum of the magnitudes of the terms of the rate, per unit of each initial value.
    rate_sizes: Vec<f64>,
}

impl EventFunction {
    /// Prepares a function for a regime with these parts and this window, s.
    pub fn new(
        linear: Linear,
        limits: Limits,
        modes: &Modes,
        (integrals, window): (&Integrals, f64),
        clusters: &[Cluster],
    ) -> Self {
        let row = linear
            .state
            .map(|entry| Complex::new(entry, 0.0))
            .transpose();
        let mut values: Vec<Complex<f64>> = (row * &modes.columns).iter().copied().collect();
        for (value, phase) in values.iter_mut().zip(&modes.phase) {
            if let Some(phase) = phase {
                // beta sin + gamma cos = Re((gamma - i beta) exp(i theta)).
                *value += Complex::new(linear.cosines[*phase], -linear.sines[*phase]);
            }
        }
        let of_integrals = integrals.weights(&linear.state);
        let felt_any = of_integrals.iter().any(|weight| *weight != 0.0);
        let sinusoids = linear.sines.iter().zip(&linear.cosines);
        let factors = linear.state.iter().copied();
        let factors = factors
            .chain([linear.constant])
            .chain(linear.inputs.iter().copied())
            .chain(sinusoids.flat_map(|(sine, cosine)| [*sine, *cosine]));
        let felt = factors.enumerate().filter(|(_, factor)| *factor != 0.0);
        let rate_sizes = modes.rate_sizes_by_start(&values);
        let units = modes.rest.len();
        let of_rates = integrals.rate_sizes_by_start(&of_integrals, units);
        let rate_sizes = rate_sizes.iter().zip(of_rates).map(|(a, b)| a + b);
        Self {
            weights: weights(&values, modes),
            value_weights: value_weights(&values),
            polynomial: if felt_any {
                integrals.polynomial(&of_integrals, window)
            } else {
                Polynomial::default()
            },
            cluster_powers: clusters
                .iter()
                .map(|c| c.projections(&linear.state))
                .collect(),
            felt: felt.collect(),
            rate_sizes: rate_sizes.collect(),
            linear,
            limits,
        }
    }

    /// Returns the value at the start of a motion, and the sum of the magnitudes of its terms. `given` are the
    /// initial values: the state, a unit constant, the inputs, and sine and cosine of each phase.
    pub fn evaluate(&self, given: &[f64]) -> (f64, f64) {
        let (mut value, mut size) = (0.0, 0.0_f64);
        for (index, factor) in &self.felt {
            let term = factor * given[*index];
            value += term;
            size += term.abs();
        }
        (value, size)
    }

    /// Returns the sum of the magnitudes of the terms of the rate at the start of a motion.
    pub fn rate_size(&self, given: &[f64]) -> f64 {
        let terms = self.rate_sizes.iter().zip(given);
        terms.map(|(size, given)| size * given.abs()).sum()
    }
}

/// Returns the factors of all modes in the derivatives, given their factors in the value.
fn weights(values: &[Complex<f64>], modes: &Modes) -> Vec<Weights> {
    let of = |((value, rate), magnitude): ((&Complex<f64>, &Complex<f64>), &f64)| {
        let factors = [0, 1, 2, 3].map(|order| value * rate.powu(order));
        let size = |order: i32| value.norm() * magnitude.powi(order);
        Weights {
            re: SimdVector::new(factors.map(|factor| factor.re)),
            im: SimdVector::new(factors.map(|factor| factor.im)),
            size: SimdVector::new([size(0), size(1), size(4), size(2)]),
        }
    };
    let rates = values.iter().zip(&modes.rate).zip(&modes.magnitude);
    rates.map(of).collect()
}

/// Returns the factors in the value, packed in SIMD vectors.
fn value_weights(values: &[Complex<f64>]) -> Vec<ValueWeights> {
    let parts = SplitComplex::new(values);
    let sizes: Vec<f64> = values.iter().map(|value| value.norm()).collect();
    let pairs = parts.re.iter().zip(&parts.im).zip(pack(&sizes));
    pairs
        .map(|((re, im), size)| ValueWeights {
            re: *re,
            im: *im,
            size,
        })
        .collect()
}

/// Writes tau^k / k! for k = 0 .. out.len() - 1.
pub(super) fn write_monomials(tau: f64, out: &mut [f64]) {
    let mut value = 1.0;
    for (k, slot) in out.iter_mut().enumerate() {
        *slot = value;
        value *= tau / (k + 1) as f64;
    }
}

/// Returns T^k / k! for a bound; 0 for a negative k.
pub(super) fn monomial(time: f64, k: i32) -> f64 {
    if k < 0 {
        return 0.0;
    }
    time.powi(k) / factorial(k as usize)
}
