//! Neighbouring motions to first order: tangent vectors carried along a motion, through the
//! flow exactly and through switches by the saltation matrix.

use nalgebra::{Complex, DVector};

use super::flow::Flow;
use super::functional::monomials;
use super::propagator::{Change, Follow, Segment};
use super::regime::Regime;

/// Tangent vectors of a motion.
#[derive(Clone, Debug, Default)]
pub(super) struct Tangents {
    /// One state difference each.
    pub vectors: Vec<Vec<f64>>,
    factors: Vec<Complex<f64>>,
    sum: Vec<f64>,
    rates: [Vec<f64>; 2],
}

impl Tangents {
    /// Tangent vectors to be carried along.
    pub fn new(vectors: Vec<Vec<f64>>) -> Self {
        Self {
            vectors,
            ..Self::default()
        }
    }

    /// Carries the vectors on for `tau` s.
    pub fn advance(&mut self, regime: &Regime, tau: f64) {
        self.factors.clear();
        self.factors
            .extend(regime.modes.rate.iter().map(|rate| (rate * tau).exp()));
        for vector in &mut self.vectors {
            carry(regime, &self.factors, tau, vector, &mut self.sum);
        }
    }
}

impl Tangents {
    /// Takes the vectors through a switch. `displacements`: how much the function's distance
    /// from its limit differs in the neighbouring motion at the same state; 0 where missing.
    pub fn switch(&mut self, change: &Change<'_>, displacements: &[f64]) {
        let row = change.function.state.as_slice();
        let dot = |vector: &[f64]| row.iter().zip(vector).map(|(a, b)| a * b).sum::<f64>();
        let displacement = |place: usize| displacements.get(place).copied().unwrap_or(0.0);
        if let Some(constant) = change.saltation {
            for (place, vector) in self.vectors.iter_mut().enumerate() {
                let along = dot(vector) + displacement(place);
                let slots = vector.iter_mut().zip(constant.iter());
                slots.for_each(|(slot, u)| *slot += u * along);
            }
            return;
        }
        for (rates, regime) in self.rates.iter_mut().zip([change.before, change.after]) {
            rates.resize(row.len(), 0.0);
            regime.rates(change.state, change.inputs, change.phases, rates);
        }
        let [before, after] = &self.rates;
        let rate = dot(before) + change.explicit_rate;
        if rate == 0.0 {
            return;
        }
        for (place, vector) in self.vectors.iter_mut().enumerate() {
            let delay = (dot(vector) + displacement(place)) / rate;
            for ((slot, a), b) in vector.iter_mut().zip(after).zip(before) {
                *slot += (a - b) * delay;
            }
        }
    }
}

impl Follow for Tangents {
    fn flowed(&mut self, segment: &Segment<'_>, _flow: &mut Flow) {
        self.advance(segment.regime, segment.tau);
    }

    fn switched(&mut self, change: &Change<'_>) {
        self.switch(change, &[]);
    }
}

/// Replaces a state difference by what the flow makes of it after `tau` s, given the
/// modes' factors exp(rate tau).
fn carry(
    regime: &Regime,
    factors: &[Complex<f64>],
    tau: f64,
    vector: &mut [f64],
    sum: &mut Vec<f64>,
) {
    let states = vector.len();
    let modes = &regime.modes;
    sum.clear();
    sum.resize(states, 0.0);
    let mut amplitudes = vec![Complex::new(0.0, 0.0); factors.len()];
    for (value, rows) in vector.iter().zip(&modes.rows) {
        for (mode, amplitude) in amplitudes.iter_mut().enumerate() {
            *amplitude += rows.get(mode) * *value;
        }
    }
    for (mode, (start, factor)) in amplitudes.iter().zip(factors).enumerate() {
        let place = mode * states..(mode + 1) * states;
        let now = start * factor;
        let columns = modes.columns[0][place.clone()]
            .iter()
            .zip(&modes.columns[1][place]);
        for (slot, (re, im)) in sum.iter_mut().zip(columns) {
            *slot += re * now.re - im * now.im;
        }
    }
    let difference = DVector::from_column_slice(vector);
    add_polynomial(regime, tau, &difference, sum);
    for cluster in &regime.clusters {
        let start = &cluster.rows * difference.map(|entry| Complex::new(entry, 0.0));
        let mut powers = vec![0.0; cluster.terms];
        monomials(tau, &mut powers);
        let mut value = DVector::zeros(start.len());
        for power in powers.iter().rev() {
            value = &cluster.matrix * value + &start * Complex::new(*power, 0.0);
        }
        value *= (cluster.centre * tau).exp();
        for (slot, row) in sum.iter_mut().zip(cluster.columns.row_iter()) {
            *slot += row
                .iter()
                .zip(value.iter())
                .map(|(c, v)| (c * v).re)
                .sum::<f64>();
        }
    }
    vector.copy_from_slice(sum);
}

fn add_polynomial(regime: &Regime, tau: f64, difference: &DVector<f64>, sum: &mut [f64]) {
    let polynomial = &regime.polynomial;
    if polynomial.terms == 0 {
        return;
    }
    let start = &polynomial.rows * difference;
    let mut powers = vec![0.0; polynomial.terms];
    monomials(tau, &mut powers);
    let mut value = DVector::zeros(start.len());
    for power in powers.iter().rev() {
        value = &polynomial.matrix * value;
        value.axpy(*power, &start, 1.0);
    }
    for (column, amplitude) in polynomial.columns.column_iter().zip(value.iter()) {
        for (slot, entry) in sum.iter_mut().zip(column.iter()) {
            *slot += entry * amplitude;
        }
    }
}
