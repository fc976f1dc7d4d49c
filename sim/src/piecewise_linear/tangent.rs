//! Neighbouring motions to first order: tangent vectors carried along a motion, through the
//! flow exactly and through switches by the saltation matrix.

use fearless_simd::{Level, Simd, dispatch};
use nalgebra::{Complex, DVector};

use super::flow::Flow;
use super::functional::monomials;
use super::lanes::{self, Lane, Pairs, numbers, numbers_mut};
use super::propagator::{Change, Follow, Segment};
use super::regime::{Cluster, Regime};

/// Tangent vectors of a motion.
#[derive(Clone, Debug, Default)]
pub(super) struct Tangents {
    /// One state difference each.
    pub vectors: Vec<Vec<f64>>,
    neighbour: Neighbour,
    rates: [Vec<f64>; 2],
}

/// Memory for one vector on its way.
#[derive(Clone, Debug, Default)]
struct Neighbour {
    coordinates: Vec<Lane>,
    /// How the integrals move.
    transition: Vec<Lane>,
    moved: Vec<Lane>,
    sum: Vec<Lane>,
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
        let gains = Pairs::gains(&regime.modes.rate, tau);
        let (neighbour, vectors) = (&mut self.neighbour, &mut self.vectors);
        dispatch!(Level::new(), simd => {
            let transition = &mut neighbour.transition;
            let integrals = &regime.integrals;
            integrals.transition(simd, tau, integrals.felt(), transition);
            for vector in vectors {
                neighbour.carry(simd, regime, &gains, tau, vector);
            }
        });
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

impl Neighbour {
    /// Adds to a state difference what the flow makes of it after `tau` s, given the modes'
    /// gains over that time.
    #[inline(always)]
    fn carry<S: Simd>(
        &mut self,
        simd: S,
        regime: &Regime,
        gains: &Pairs,
        tau: f64,
        vector: &mut [f64],
    ) {
        let groups = regime.modes.groups();
        self.coordinates.clear();
        self.coordinates
            .resize(2 * groups + regime.integrals.groups(), Lane::ZERO);
        regime
            .coordinates
            .add_product(simd, vector, &mut self.coordinates);
        for group in 0..groups {
            let (a, b) = (self.coordinates[group], self.coordinates[groups + group]);
            let (c, d) = (gains.re[group], gains.im[group]);
            self.coordinates[group] = a * c - b * d;
            self.coordinates[groups + group] = a * d + b * c;
        }
        let integrals = &mut self.coordinates[2 * groups..];
        self.moved.resize(integrals.len(), Lane::ZERO);
        let causes = regime.integrals.free_causes(integrals);
        regime
            .integrals
            .moved(simd, causes, &self.transition, &mut self.moved);
        integrals.copy_from_slice(&self.moved);
        self.sum.clear();
        self.sum.resize(lanes::groups(vector.len()), Lane::ZERO);
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

/// Adds how far a cluster moves a state difference in `tau` s.
fn add_cluster(cluster: &Cluster, tau: f64, vector: &[f64], sum: &mut [f64]) {
    let difference = DVector::from_iterator(
        vector.len(),
        vector.iter().map(|entry| Complex::new(*entry, 0.0)),
    );
    let start = &cluster.rows * difference;
    let mut powers = vec![0.0; cluster.terms];
    monomials(tau, &mut powers);
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
