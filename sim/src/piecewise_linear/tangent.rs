//! Tangent vectors of a motion: propagated exactly between switches, and transformed by the saltation matrix at
//! switches.

use fearless_simd::Simd;

use crate::registers::dispatch_registers;
use nalgebra::{Complex, DVector};

use super::event_function::write_monomials;
use super::flow::Flow;
use super::propagator::{Change, Follow, Segment};
use super::regime::{Cluster, Regime};
use super::simd_vectors::{self, SimdVector, SplitComplex, numbers, numbers_mut};

/// Tangent vectors of a motion.
#[derive(Clone, Debug, Default)]
pub(super) struct Tangents {
    /// Differences of the state, one per vector.
    pub vectors: Vec<Vec<f64>>,
    neighbour: Neighbour,
    rates: [Vec<f64>; 2],
}

/// Memory for the propagation of one vector.
#[derive(Clone, Debug, Default)]
struct Neighbour {
    coordinates: Vec<SimdVector>,
    /// Transition matrix of the integrals.
    transition: Vec<SimdVector>,
    moved: Vec<SimdVector>,
    sum: Vec<SimdVector>,
}

impl Tangents {
    /// Creates tangent vectors.
    pub fn new(vectors: Vec<Vec<f64>>) -> Self {
        Self {
            vectors,
            ..Self::default()
        }
    }

    /// Propagates the vectors over `tau` s.
    pub fn advance(&mut self, regime: &Regime, tau: f64) {
        let expm1 = SplitComplex::expm1(&regime.modes.rate, tau);
        let (neighbour, vectors) = (&mut self.neighbour, &mut self.vectors);
        dispatch_registers!(simd => {
            let transition = &mut neighbour.transition;
            let integrals = &regime.integrals;
            integrals.transition(simd, tau, integrals.cause_count(), transition);
            for vector in vectors {
                neighbour.propagate_vector(simd, regime, &expm1, tau, vector);
            }
        });
    }
}

impl Tangents {
    /// Applies the saltation matrix of a switch to the vectors.
    pub fn switch(&mut self, change: &Change<'_>) {
        let row = change.function.state.as_slice();
        let dot = |vector: &[f64]| row.iter().zip(vector).map(|(a, b)| a * b).sum::<f64>();
        if let Some(constant) = change.saltation {
            for vector in &mut self.vectors {
                let along = dot(vector);
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
        for vector in &mut self.vectors {
            let delay = dot(vector) / rate;
            for ((slot, a), b) in vector.iter_mut().zip(after).zip(before) {
                *slot += (a - b) * delay;
            }
        }
    }
}

impl Follow for Tangents {
    fn observe_segment(&mut self, segment: &Segment<'_>, _flow: &mut Flow) {
        self.advance(segment.regime, segment.tau);
    }

    fn observe_switch(&mut self, change: &Change<'_>) {
        self.switch(change);
    }
}

impl Neighbour {
    /// Propagates a difference of the state over `tau` s, given the modes' expm1 over that time.
    #[inline(always)]
    fn propagate_vector<S: Simd>(
        &mut self,
        simd: S,
        regime: &Regime,
        expm1: &SplitComplex,
        tau: f64,
        vector: &mut [f64],
    ) {
        let vectors = regime.modes.simd_vectors();
        self.coordinates.clear();
        self.coordinates.resize(
            2 * vectors + regime.integrals.simd_vectors(),
            SimdVector::ZERO,
        );
        regime
            .coordinates
            .add_product(simd, vector, &mut self.coordinates);
        for simd_vector in 0..vectors {
            let (a, b) = (
                self.coordinates[simd_vector],
                self.coordinates[vectors + simd_vector],
            );
            let (c, d) = (expm1.re[simd_vector], expm1.im[simd_vector]);
            self.coordinates[simd_vector] = a * c - b * d;
            self.coordinates[vectors + simd_vector] = a * d + b * c;
        }
        let integrals = &mut self.coordinates[2 * vectors..];
        self.moved.resize(integrals.len(), SimdVector::ZERO);
        let causes = regime.integrals.free_causes(integrals);
        regime
            .integrals
            .moved(simd, causes, &self.transition, &mut self.moved);
        integrals.copy_from_slice(&self.moved);
        self.sum.clear();
        self.sum
            .resize(simd_vectors::simd_vectors(vector.len()), SimdVector::ZERO);
        regime
            .states
            .add_product(simd, numbers(&self.coordinates), &mut self.sum);
        for cluster in &regime.clusters {
            add_cluster(cluster, tau, vector, numbers_mut(&mut self.sum));
        }
        for (slot, moved) in vector.iter_mut().zip(numbers(&self.sum)) {
            *slot += moved;
        }
    }
}

/// Adds the change of a state difference by a cluster in `tau` s.
fn add_cluster(cluster: &Cluster, tau: f64, vector: &[f64], sum: &mut [f64]) {
    let difference = DVector::from_iterator(
        vector.len(),
        vector.iter().map(|entry| Complex::new(*entry, 0.0)),
    );
    let start = &cluster.rows * difference;
    let mut powers = vec![0.0; cluster.terms];
    write_monomials(tau, &mut powers);
    let mut value = DVector::zeros(start.len());
    for power in powers.iter().rev() {
        value = &cluster.matrix * value + &start * Complex::new(*power, 0.0);
    }
    let moved = value * (cluster.centre * tau).exp() - start;
    for (slot, row) in sum.iter_mut().zip(cluster.columns.row_iter()) {
        let terms = row.iter().zip(moved.iter());
        *slot += terms.map(|(c, v)| (c * v).re).sum::<f64>();
    }
}
