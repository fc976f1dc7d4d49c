//! The motion within one regime from one state on: amplitudes, polynomial, time.
//!
//! A flow stands at a time tau after its start. It advances by a step of the ladder or to
//! any time, gives the values and derivatives of the regime's functions where it stands,
//! and the state there.

use nalgebra::{Complex, DVector};

use super::cluster_flow::ClusterFlow;
use super::forced::{DERIVATIVES, integrals, reciprocal};
use super::functional::{Functional, monomials};
use super::ladder::Rung;
use super::lanes::{LITTLE, Lane, Pairs, dot, groups};
use super::regime::Regime;

/// The roundings of a few operations on a number of size 1.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Powers of time beyond those of the integrals that a sinusoidal force adds.
const SINUSOIDAL: usize = 8;

/// The largest angle by which a sinusoid turns in a window if the integrals matter: then
/// the first power left out is below 1e-17 of the response.
pub(super) const SINUSOIDAL_ANGLE: f64 = 1.0 / 16.0;

/// A motion in one regime. Its memory is used again for the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct Flow {
    /// Since the start, s.
    pub tau: f64,
    /// Each mode's amplitude at the start.
    start: Pairs,
    /// The same at tau.
    now: Pairs,
    /// Magnitudes of the amplitudes at tau.
    size: Vec<Lane>,
    /// exp(i theta) of each phase at the start.
    phases: Vec<Complex<f64>>,
    /// Integrals at the start.
    zeta: DVector<f64>,
    /// Their constant rates.
    drift: DVector<f64>,
    /// The constant part of the state.
    steady: Vec<f64>,
    /// For each function what is particular to this flow.
    own: Vec<Own>,
    clusters: Vec<ClusterFlow>,
    /// The state without what is constant and forced; scratch.
    free: Vec<f64>,
    /// Scratch for the integrals at the end.
    value: DVector<f64>,
    product: DVector<f64>,
    monomials: Vec<f64>,
    forced: Vec<Complex<f64>>,
}

/// What a function is made of in one flow.
#[derive(Clone, Debug, Default)]
struct Own {
    /// Coefficients of the powers of tau.
    polynomial: Vec<f64>,
    /// A bound of the polynomial's fourth derivative within the window.
    fourth: f64,
    /// The sum of its terms' magnitudes.
    size: f64,
    /// Sums over the first modes, from none to all.
    partial: Vec<Partial>,
    /// The polynomial's derivatives of order 0 to 3.
    derivatives: [f64; 4],
}

/// Value and derivatives of a function where a flow stands, with bounds.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Local {
    /// The value and the derivatives of order 1 to 3, of the slow modes only.
    pub derivatives: [f64; 4],
    /// A bound of the magnitude of the fourth derivative of the slow modes.
    pub fourth: f64,
    /// A bound of the fast modes' contribution to the value.
    pub fast: f64,
    /// A bound of the fast modes' contribution to the first derivative.
    pub fast_rate: f64,
    /// What rounding may make of the value.
    pub noise: f64,
    /// What rounding may make of the first derivative.
    pub rate_noise: f64,
}

/// Sums over the slowest modes.
#[derive(Clone, Copy, Debug)]
struct Partial {
    /// Derivatives of order 0 to 3.
    derivatives: Lane,
    /// Magnitudes of the orders 0, 1 and 4.
    sizes: Lane,
}

impl Flow {
    /// Starts at a state, with exp(i theta) of the phases there.
    pub fn start(
        &mut self,
        regime: &Regime,
        state: &[f64],
        inputs: &[f64],
        phases: &[Complex<f64>],
    ) {
        self.tau = 0.0;
        self.phases.clear();
        self.phases.extend_from_slice(phases);
        combine(&regime.steady, inputs, &mut self.steady);
        self.start_modes(regime, state);
        self.start_integrals(regime, state, inputs);
        self.clusters.clear();
        for cluster in &regime.clusters {
            self.clusters
                .push(ClusterFlow::new(cluster, state, inputs, phases));
        }
        self.own.resize_with(regime.functionals.len(), Own::default);
        let none = Partial {
            derivatives: Lane::ZERO,
            sizes: Lane::ZERO,
        };
        for (own, functional) in self.own.iter_mut().zip(&regime.functionals) {
            own.partial.resize(regime.modes.count() + 1, none);
            own.partial[0] = none;
            own.start(regime, functional, inputs, phases, &self.zeta, &self.drift);
        }
        self.measure();
    }

    fn start_modes(&mut self, regime: &Regime, state: &[f64]) {
        let modes = &regime.modes;
        let states = state.len();
        let free = &mut self.free;
        free.clear();
        free.extend(state.iter().zip(&self.steady).map(|(y, steady)| y - steady));
        for (mode, phase) in modes.phase.iter().enumerate() {
            let Some(phase) = phase else { continue };
            let (e, place) = (self.phases[*phase], mode * states..(mode + 1) * states);
            let columns = modes.columns[0][place.clone()]
                .iter()
                .zip(&modes.columns[1][place]);
            for (slot, (re, im)) in free.iter_mut().zip(columns) {
                *slot -= re * e.re - im * e.im;
            }
        }
        let start = &mut self.start;
        for (slots, part) in [(&mut start.re, 0), (&mut start.im, 1)] {
            slots.clear();
            slots.resize(groups(modes.count()), Lane::ZERO);
            for (value, rows) in free.iter().zip(&modes.rows) {
                let value = Lane::splat(*value);
                let rows = if part == 0 { &rows.re } else { &rows.im };
                for (slot, row) in slots.iter_mut().zip(rows) {
                    *slot += *row * value;
                }
            }
        }
        for (mode, phase) in modes.phase.iter().enumerate() {
            if let Some(phase) = phase {
                start.set(mode, self.phases[*phase]);
            }
        }
        self.now.re.clone_from(&self.start.re);
        self.now.im.clone_from(&self.start.im);
    }

    fn start_integrals(&mut self, regime: &Regime, state: &[f64], inputs: &[f64]) {
        let polynomial = &regime.polynomial;
        let size = polynomial.rows.nrows();
        resize(&mut self.zeta, size);
        let rows = polynomial.flat_rows.chunks_exact(state.len().max(1));
        for (slot, row) in self.zeta.iter_mut().zip(rows) {
            *slot = dot(row, state);
        }
        resize(&mut self.drift, size);
        self.drift.copy_from(&polynomial.constants[0]);
        for (column, input) in polynomial.constants[1..].iter().zip(inputs) {
            self.drift.axpy(*input, column, 1.0);
        }
    }

    /// Advances by a step of the ladder.
    pub fn step(&mut self, rung: &Rung) {
        self.tau += rung.length;
        self.now.multiply(&rung.factors);
        self.measure();
    }

    /// Advances by any time, which may be negative.
    pub fn shift(&mut self, regime: &Regime, time: f64) {
        self.tau += time;
        let fastest = regime.modes.magnitude.last().copied().unwrap_or(0.0);
        let mut rest = time;
        for rung in &regime.ladder.rungs {
            if fastest * rest.abs() <= LITTLE || rest <= 0.0 {
                break;
            }
            if rung.length <= rest {
                self.now.multiply(&rung.factors);
                rest -= rung.length;
            }
        }
        if fastest * rest.abs() <= LITTLE {
            self.now.turn_little(&regime.modes.rates, rest);
        } else {
            let factors: Vec<Complex<f64>> = regime
                .modes
                .rate
                .iter()
                .map(|rate| (rate * rest).exp())
                .collect();
            self.now.multiply(&Pairs::of(&factors));
        }
        self.measure();
    }

    /// Goes to a time after the start.
    pub fn go_to(&mut self, regime: &Regime, tau: f64) {
        let factors: Vec<Complex<f64>> = regime
            .modes
            .rate
            .iter()
            .map(|rate| (rate * tau).exp())
            .collect();
        self.now.re.clone_from(&self.start.re);
        self.now.im.clone_from(&self.start.im);
        self.now.multiply(&Pairs::of(&factors));
        self.tau = tau;
        self.measure();
    }

    /// Whether no amplitude has overflowed.
    pub fn is_finite(&self) -> bool {
        let polynomials = self.own.iter().flat_map(|own| &own.derivatives);
        let sizes = self.size.iter().flat_map(|size| size.as_array());
        polynomials.chain(sizes).all(|value| value.is_finite())
    }

    fn measure(&mut self) {
        self.size.resize(self.now.re.len(), Lane::ZERO);
        for (slot, (a, b)) in self
            .size
            .iter_mut()
            .zip(self.now.re.iter().zip(&self.now.im))
        {
            *slot = (*a * *a + *b * *b).sqrt();
        }
    }

    /// Sums up a function over its modes here.
    pub fn sum_up(&mut self, regime: &Regime, place: usize) {
        let own = &mut self.own[place];
        let mut partial = Partial {
            derivatives: Lane::ZERO,
            sizes: Lane::ZERO,
        };
        let groups = self.now.re.iter().zip(&self.now.im).zip(&self.size);
        let weights = regime.functionals[place].weights.chunks(4);
        let slots = own.partial[1..].chunks_mut(4);
        for ((weights, slots), ((re, im), size)) in weights.zip(slots).zip(groups) {
            let amplitudes = re.as_array().iter().zip(im.as_array()).zip(size.as_array());
            for ((weights, slot), ((re, im), size)) in weights.iter().zip(slots).zip(amplitudes) {
                partial.derivatives +=
                    weights.re * Lane::splat(*re) - weights.im * Lane::splat(*im);
                partial.sizes += weights.size * Lane::splat(*size);
                *slot = partial;
            }
        }
        own.evaluate(self.tau);
    }

    /// Value and derivatives of a function that has been summed up here, with bounds over
    /// the next step of `rung`.
    pub fn local(&self, regime: &Regime, place: usize, rung: &Rung) -> Local {
        let own = &self.own[place];
        let (slow, last) = (&own.partial[rung.slow], own.partial.len() - 1);
        let mut derivatives = slow.derivatives.to_array();
        for (slot, value) in derivatives.iter_mut().zip(own.derivatives) {
            *slot += value;
        }
        let all = own.partial[last].sizes.to_array();
        let some = slow.sizes.to_array();
        let (mut fast, mut fast_rate) = (0.0, 0.0);
        if rung.slow < last {
            // The difference of two sums, with their rounding.
            fast = (all[0] - some[0] + ROUNDING * all[0]) * rung.growth;
            fast_rate = (all[1] - some[1] + ROUNDING * all[1]) * rung.growth;
        }
        let mut local = Local {
            derivatives,
            fourth: some[2] * rung.growth + own.fourth,
            fast,
            fast_rate,
            noise: all[0] + own.size,
            rate_noise: all[1] + own.derivatives[1].abs(),
        };
        for (cluster, flow) in self.clusters.iter().enumerate() {
            let powers = &regime.functionals[place].cluster_powers[cluster];
            let of = &regime.clusters[cluster];
            flow.add_to(
                of,
                powers,
                &regime.system.phases,
                (self.tau, rung.length),
                &mut local,
            );
        }
        local.noise *= ROUNDING;
        local.rate_noise *= ROUNDING;
        local
    }

    /// The state here.
    pub fn state(&mut self, regime: &Regime, out: &mut [f64]) {
        out.copy_from_slice(&self.steady);
        let modes = &regime.modes;
        let states = out.len();
        for mode in 0..modes.count() {
            let place = mode * states..(mode + 1) * states;
            let amplitude = self.now.get(mode);
            let columns = modes.columns[0][place.clone()]
                .iter()
                .zip(&modes.columns[1][place]);
            for (slot, (re, im)) in out.iter_mut().zip(columns) {
                *slot += re * amplitude.re - im * amplitude.im;
            }
        }
        self.add_integrals(regime, out);
        for (flow, cluster) in self.clusters.iter().zip(&regime.clusters) {
            flow.add_state(cluster, &regime.system.phases, self.tau, out);
        }
    }

    fn add_integrals(&mut self, regime: &Regime, out: &mut [f64]) {
        let polynomial = &regime.polynomial;
        let (terms, size) = (polynomial.terms, polynomial.rows.nrows());
        if size == 0 {
            return;
        }
        self.monomials.resize(terms + 1, 0.0);
        monomials(self.tau, &mut self.monomials);
        let orders = DERIVATIVES + terms;
        self.forced
            .resize(orders * self.phases.len(), Complex::new(0.0, 0.0));
        for (place, values) in self.forced.chunks_exact_mut(orders).enumerate() {
            let nu = Complex::new(0.0, regime.system.phases[place][0]);
            integrals(nu, self.tau, (nu * self.tau).exp(), values);
            values
                .iter_mut()
                .for_each(|value| *value *= self.phases[place]);
        }
        resize(&mut self.value, size);
        resize(&mut self.product, size);
        for k in (0..terms).rev() {
            self.product.gemv(1.0, &polynomial.matrix, &self.value, 0.0);
            std::mem::swap(&mut self.value, &mut self.product);
            self.value.axpy(self.monomials[k], &self.zeta, 1.0);
            self.value.axpy(self.monomials[k + 1], &self.drift, 1.0);
            for (place, [beta, gamma]) in polynomial.sinusoids.iter().enumerate() {
                let forced = self.forced[place * orders + DERIVATIVES + k];
                self.value.axpy(forced.im, beta, 1.0);
                self.value.axpy(forced.re, gamma, 1.0);
            }
        }
        for (column, amplitude) in polynomial.columns.column_iter().zip(self.value.iter()) {
            for (slot, entry) in out.iter_mut().zip(column.iter()) {
                *slot += entry * amplitude;
            }
        }
    }
}

/// Zeros, so many.
fn resize(vector: &mut DVector<f64>, size: usize) {
    if vector.len() == size {
        vector.fill(0.0);
    } else {
        *vector = DVector::zeros(size);
    }
}

/// first + sum of the others times the inputs.
fn combine(columns: &[DVector<f64>], inputs: &[f64], out: &mut Vec<f64>) {
    out.clear();
    out.extend(columns[0].iter());
    for (column, input) in columns[1..].iter().zip(inputs) {
        for (slot, entry) in out.iter_mut().zip(column.iter()) {
            *slot += entry * input;
        }
    }
}

impl Own {
    fn start(
        &mut self,
        regime: &Regime,
        functional: &Functional,
        inputs: &[f64],
        phases: &[Complex<f64>],
        zeta: &DVector<f64>,
        drift: &DVector<f64>,
    ) {
        let mut offset = functional.offsets[0];
        for (factor, input) in functional.offsets[1..].iter().zip(inputs) {
            offset += factor * input;
        }
        let polynomial = &mut self.polynomial;
        polynomial.clear();
        self.fourth = 0.0;
        if !functional.has_integrals() {
            polynomial.push(offset);
            self.size = offset.abs();
            return;
        }
        let terms = functional.powers.len() / zeta.len().max(1);
        let sinusoidal = if phases.is_empty() { 0 } else { SINUSOIDAL };
        polynomial.resize(terms + 1 + sinusoidal, 0.0);
        let powers = functional.powers.chunks_exact(zeta.len().max(1));
        for (k, power) in powers.enumerate() {
            for ((factor, zeta), drift) in power.iter().zip(zeta.iter()).zip(drift.iter()) {
                polynomial[k] += factor * zeta;
                polynomial[k + 1] += factor * drift;
            }
        }
        for (place, factors) in functional.forced.iter().enumerate() {
            // The sum of factors times I_k as a series in time.
            let turn = Complex::new(0.0, regime.system.phases[place][0]);
            let mut sum = Complex::new(0.0, 0.0);
            for (k, slot) in polynomial[1..].iter_mut().enumerate() {
                sum *= turn;
                if let Some(factor) = factors.get(k) {
                    sum += factor * phases[place];
                }
                *slot += sum.im;
            }
        }
        let window = regime.ladder.window;
        let (mut factor, mut power) = (1.0, 1.0);
        for (k, slot) in polynomial.iter_mut().enumerate() {
            if k >= 4 {
                self.fourth += slot.abs() * power;
                power *= window * reciprocal(k - 3);
            }
            *slot *= factor;
            factor *= reciprocal(k + 1);
        }
        polynomial[0] += offset;
    }

    /// The polynomial with three derivatives, by Horner's scheme.
    fn evaluate(&mut self, tau: f64) {
        let [mut a, mut b, mut c, mut d, mut size] = [0.0; 5];
        for coefficient in self.polynomial.iter().rev() {
            size = size * tau + coefficient.abs();
            d = d * tau + c;
            c = c * tau + b;
            b = b * tau + a;
            a = a * tau + coefficient;
        }
        self.size = size;
        self.derivatives = [a, b, 2.0 * c, 6.0 * d];
    }
}
