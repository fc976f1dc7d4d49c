//! A linear function of the motion within one regime, prepared so that its value and its
//! derivatives by time cost a few products per mode, and the limits between which it stays
//! while the regime lasts.

use codegen::affine::system::AffineRows;
use nalgebra::{Complex, DVector};

use super::forced::factorial;
use super::integrals::{Integrals, RateTerms};
use super::lanes::{Lane, Pairs, pack};
use super::modes::Modes;
use super::regime::Cluster;

/// A function of state, inputs and sinusoids: coefficients as in [`AffineRows`].
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Linear {
    pub state: DVector<f64>,
    pub inputs: Vec<f64>,
    pub sines: Vec<f64>,
    pub cosines: Vec<f64>,
    pub constant: f64,
}

impl Linear {
    /// Row `row` of some functions.
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

    /// The value at a state, with the sines and cosines of the phases.
    pub fn value(&self, state: &[f64], inputs: &[f64], phases: &[Complex<f64>]) -> f64 {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut value = dot(self.state.as_slice(), state) + dot(&self.inputs, inputs);
        for (place, phase) in phases.iter().enumerate() {
            value += self.sines[place] * phase.im + self.cosines[place] * phase.re;
        }
        value + self.constant
    }
}

/// What happens to a regime when a function reaches a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    /// The switching group the function belongs to.
    pub group: usize,
    /// The regime lasts while the function is above.
    pub low: f64,
    /// The regime lasts while the function is below.
    pub high: f64,
}

/// The factors of a group of modes in a function.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    /// Real parts in the derivatives of order 0 to 3.
    pub re: [Lane; 4],
    /// Imaginary parts.
    pub im: [Lane; 4],
    /// Magnitudes for the orders 0, 1 and 4.
    pub size: [Lane; 3],
}

/// A function prepared for one regime.
#[derive(Clone, Debug)]
pub(super) struct Functional {
    pub linear: Linear,
    pub limits: Limits,
    /// The factors of each group of modes.
    pub weights: Vec<Weights>,
    /// The factors of the integrals; none if it does not feel them.
    pub integrals: Vec<f64>,
    /// The terms of the rate that the integrals make up.
    pub rate_terms: RateTerms,
    /// row columns N^k of each cluster.
    pub cluster_powers: Vec<Vec<DVector<Complex<f64>>>>,
    /// The states it reads, with their factors.
    felt: Vec<(usize, f64)>,
}

impl Functional {
    /// Prepares a function for a regime with these parts.
    pub fn new(
        linear: Linear,
        limits: Limits,
        modes: &Modes,
        integrals: &Integrals,
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
        let mut of_integrals = integrals.weights(&linear.state);
        if of_integrals.iter().all(|weight| *weight == 0.0) {
            of_integrals.clear();
        }
        let felt = linear.state.iter().copied().enumerate();
        Self {
            weights: weights(&values, modes),
            rate_terms: integrals.rate_terms(&of_integrals),
            integrals: of_integrals,
            cluster_powers: clusters
                .iter()
                .map(|c| c.projections(&linear.state))
                .collect(),
            felt: felt.filter(|(_, factor)| *factor != 0.0).collect(),
            linear,
            limits,
        }
    }

    /// The value at a state, and the sum of its terms' magnitudes.
    pub fn at(&self, state: &[f64], inputs: &[f64], phases: &[Complex<f64>]) -> (f64, f64) {
        let linear = &self.linear;
        let (mut value, mut size) = (linear.constant, linear.constant.abs());
        let states = self
            .felt
            .iter()
            .map(|(state_index, factor)| factor * state[*state_index]);
        let inputs = linear.inputs.iter().zip(inputs).map(|(a, b)| a * b);
        let sinusoids = phases.iter().enumerate();
        let sinusoids = sinusoids.map(|(p, e)| linear.sines[p] * e.im + linear.cosines[p] * e.re);
        for term in states.chain(inputs).chain(sinusoids) {
            value += term;
            size += term.abs();
        }
        (value, size)
    }
}

/// The factors of all modes, given those in the value.
fn weights(values: &[Complex<f64>], modes: &Modes) -> Vec<Weights> {
    let factors = |order: u32| -> Pairs {
        let pairs = values.iter().zip(&modes.rate);
        let all: Vec<Complex<f64>> = pairs
            .map(|(value, rate)| value * rate.powu(order))
            .collect();
        Pairs::of(&all)
    };
    let sizes = |order: i32| -> Vec<Lane> {
        let pairs = values.iter().zip(&modes.magnitude);
        let all: Vec<f64> = pairs
            .map(|(value, rate)| value.norm() * rate.powi(order))
            .collect();
        pack(&all)
    };
    let (factors, sizes) = ([0, 1, 2, 3].map(factors), [0, 1, 4].map(sizes));
    let of = |group: usize| Weights {
        re: [0, 1, 2, 3].map(|order: usize| factors[order].re[group]),
        im: [0, 1, 2, 3].map(|order: usize| factors[order].im[group]),
        size: [0, 1, 2].map(|place: usize| sizes[place][group]),
    };
    (0..modes.groups()).map(of).collect()
}

/// tau^k / k! for k = 0 .. out.len() - 1.
pub(super) fn monomials(tau: f64, out: &mut [f64]) {
    let mut value = 1.0;
    for (k, slot) in out.iter_mut().enumerate() {
        *slot = value;
        value *= tau / (k + 1) as f64;
    }
}

/// T^k / k!, for a bound; 0 for a negative k.
pub(super) fn monomial(time: f64, k: i32) -> f64 {
    if k < 0 {
        return 0.0;
    }
    time.powi(k) / factorial(k as usize)
}
