//! The motion within one regime from one state on: how far it has moved after a time tau.
//!
//! Nothing but differences from the start is summed up: a motion that has hardly moved is as
//! accurate as its start, though it may be made of modes whose amplitudes are thousands of
//! times larger and nearly cancel. A flow advances by a step of the ladder or by any time,
//! gives the values and derivatives of the regime's functions where it stands, and the state
//! there.

use nalgebra::Complex;

use super::cluster_flow::ClusterFlow;
use super::forced::reciprocal;
use super::functional::{Functional, Weights};
use super::integrals::Series;
use super::ladder::Rung;
use super::lanes::{LITTLE, Lane, Pairs, TINY, groups, numbers, numbers_mut};
use super::regime::Regime;

/// The roundings of a few operations on a number of size 1.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Terms of a polynomial below this part of another one of lower order are left out.
const NEGLIGIBLE: f64 = 1e-19;

/// Magnitudes of amplitudes are found anew when the fastest decay since would make this much
/// of a difference to their logarithm.
const DECAYED: f64 = 0.25;

/// A motion in one regime. Its memory is used again for the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct Flow {
    /// Since the start, s.
    pub tau: f64,
    /// The state at the start.
    origin: Vec<Lane>,
    /// The coordinates at the start, as [`Regime`] has them.
    start: Vec<Lane>,
    /// How far they have moved.
    moved: Vec<Lane>,
    /// The modes' amplitudes at tau.
    now: Vec<Lane>,
    /// Their magnitudes, when they were found, s, and how often.
    size: Vec<Lane>,
    measured_at: f64,
    measurements: u64,
    /// The integrals.
    series: Series,
    /// For each function what is particular to this flow.
    own: Vec<Own>,
    clusters: Vec<ClusterFlow>,
    /// The state to be.
    sum: Vec<Lane>,
}

/// What a function is made of in one flow.
#[derive(Clone, Debug, Default)]
struct Own {
    /// It keeps its limits until then, s after the start.
    safe_until: f64,
    /// Where it was last summed up, s after the start.
    summed_up_at: f64,
    /// The value at the start.
    start: f64,
    /// The sum of its terms' magnitudes.
    start_size: f64,
    /// Coefficients of the powers of tau from the first on.
    polynomial: Vec<f64>,
    /// The sum of the magnitudes of the terms of the first coefficient, which may cancel.
    rate_size: f64,
    /// A bound of the polynomial's fourth derivative within the window.
    fourth: f64,
    /// The value, and what its terms' magnitudes add up to.
    value: f64,
    size: f64,
    /// Sums over the first groups of modes, from none to all: the amplitudes' part of the
    /// value, and derivatives of order 1 to 3.
    partial: Vec<Sums<4>>,
    /// The same of the magnitudes of the orders 0, 1 and 4, and of which measurement.
    sizes: Vec<Sums<3>>,
    measurement: u64,
    /// The amplitudes' part of the value, and derivatives of order 1 to 3, of all modes.
    amplitudes: [f64; 4],
    /// Magnitudes of the orders 0, 1 and 4, of all modes.
    all: [f64; 3],
    /// The polynomial's derivatives of order 1 to 3.
    derivatives: [f64; 3],
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
    /// The part of it that adds to the value in proportion to time.
    pub drift_noise: f64,
}

/// Sums over the slowest groups of modes, four side by side.
type Sums<const KINDS: usize> = [Lane; KINDS];

/// What the last sums hold beyond the first ones, without so many modes of the first group
/// beyond.
#[inline]
fn beyond<const KINDS: usize>(sums: &[Sums<KINDS>], modes: usize) -> [f64; KINDS] {
    let (before, first, last) = (&sums[0], &sums[1], &sums[sums.len() - 1]);
    std::array::from_fn(|kind| {
        let skipped = (first[kind] - before[kind]) * MASKS[modes];
        (last[kind] - before[kind] - skipped).reduce_add()
    })
}

/// One for so many lanes.
const MASKS: [Lane; 4] = [
    Lane::new([0.0; 4]),
    Lane::new([1.0, 0.0, 0.0, 0.0]),
    Lane::new([1.0, 1.0, 0.0, 0.0]),
    Lane::new([1.0, 1.0, 1.0, 0.0]),
];

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
        self.measured_at = f64::NAN;
        self.origin.resize(groups(state.len()), Lane::ZERO);
        numbers_mut(&mut self.origin)[..state.len()].copy_from_slice(state);
        self.find_coordinates(regime, state, inputs, phases);
        let modes = 2 * regime.modes.groups();
        regime.integrals.derivatives(
            &self.start[modes..],
            Some((inputs, phases)),
            &mut self.series,
        );
        self.clusters.clear();
        for cluster in &regime.clusters {
            self.clusters
                .push(ClusterFlow::new(cluster, state, inputs, phases));
        }
        self.own.resize_with(regime.functionals.len(), Own::default);
        for (own, functional) in self.own.iter_mut().zip(&regime.functionals) {
            let sums = regime.modes.groups() + 1;
            own.partial.resize(sums, [Lane::ZERO; 4]);
            own.sizes.resize(sums, [Lane::ZERO; 3]);
            own.safe_until = f64::NEG_INFINITY;
            own.summed_up_at = f64::NAN;
            (own.start, own.start_size) = functional.at(state, inputs, phases);
            own.find_polynomial(regime, functional, &self.series.derivatives);
            let zeta = &self.start[modes..];
            let forces = (inputs, phases);
            own.rate_size = regime
                .integrals
                .rate_size(&functional.rate_terms, zeta, forces);
        }
        self.measure(regime);
    }

    fn find_coordinates(
        &mut self,
        regime: &Regime,
        state: &[f64],
        inputs: &[f64],
        phases: &[Complex<f64>],
    ) {
        let modes = regime.modes.groups();
        let start = &mut self.start;
        start.clear();
        start.resize(2 * modes + regime.integrals.groups(), Lane::ZERO);
        regime.coordinates.add_product(state, start);
        let units = std::iter::once(&1.0).chain(inputs);
        for (rest, unit) in regime.rest.iter().zip(units) {
            subtract(rest, *unit, start);
        }
        for ([sine, cosine], e) in regime.forced.iter().zip(phases) {
            subtract(sine, e.im, start);
            subtract(cosine, e.re, start);
        }
        let slots = numbers_mut(start);
        for (mode, phase) in regime.modes.phase.iter().enumerate() {
            if let Some(phase) = phase {
                slots[mode] = phases[*phase].re;
                slots[4 * modes + mode] = phases[*phase].im;
            }
        }
        self.rewind(regime);
    }

    /// Goes back to the start.
    fn rewind(&mut self, regime: &Regime) {
        self.moved.clear();
        self.moved.resize(self.start.len(), Lane::ZERO);
        self.now.clear();
        self.now
            .extend_from_slice(&self.start[..2 * regime.modes.groups()]);
    }

    /// Advances the modes by their gains over some time.
    fn advance(&mut self, gains: &Pairs) {
        for group in 0..gains.re.len() {
            self.advance_group(group, gains.re.len(), (gains.re[group], gains.im[group]));
        }
    }

    /// Advances one of so many groups of modes by its gain.
    #[inline(always)]
    fn advance_group(&mut self, re: usize, groups: usize, (c, d): (Lane, Lane)) {
        let im = groups + re;
        let (a, b) = (self.now[re], self.now[im]);
        self.moved[re] += a * c - b * d;
        self.moved[im] += a * d + b * c;
        self.now[re] = self.start[re] + self.moved[re];
        self.now[im] = self.start[im] + self.moved[im];
    }

    /// Advances by a step of the ladder.
    pub fn step(&mut self, regime: &Regime, rung: &Rung) {
        self.tau += rung.length;
        self.advance(&rung.gains);
        self.measure(regime);
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
                self.advance(&rung.gains);
                rest -= rung.length;
            }
        }
        if fastest * rest.abs() <= LITTLE {
            self.advance_little(&regime.modes.rates, rest, fastest);
        } else {
            self.advance(&Pairs::gains(&regime.modes.rate, rest));
        }
        self.measure(regime);
    }

    /// Advances by so little that a short series gives the gains.
    fn advance_little(&mut self, rates: &Pairs, time: f64, fastest: f64) {
        let groups = rates.re.len();
        let terms = if fastest * time.abs() <= TINY { 3 } else { 7 };
        let time = Lane::splat(time);
        for group in 0..groups {
            self.advance_group(group, groups, rates.little_gain(group, time, terms));
        }
    }

    /// Goes to a time after the start.
    pub fn go_to(&mut self, regime: &Regime, tau: f64) {
        self.rewind(regime);
        self.advance(&Pairs::gains(&regime.modes.rate, tau));
        self.tau = tau;
        self.measure(regime);
    }

    /// Whether no amplitude has overflowed.
    pub fn is_finite(&self) -> bool {
        let values = self.own.iter().flat_map(|own| [own.value, own.size]);
        let sizes = self.size.iter().flat_map(|size| size.to_array());
        values.chain(sizes).all(|value| value.is_finite())
    }

    /// Finds the amplitudes' magnitudes anew, if they may have shrunk by much.
    fn measure(&mut self, regime: &Regime) {
        let decayed = (self.tau - self.measured_at) * regime.modes.damping;
        if (0.0..DECAYED).contains(&decayed) {
            return;
        }
        self.measured_at = self.tau;
        let (re, im) = self.now.split_at(self.now.len() / 2);
        self.measurements += 1;
        self.size.clear();
        let squares = re.iter().zip(im).map(|(a, b)| *a * *a + *b * *b);
        self.size.extend(squares.map(Lane::sqrt));
    }

    /// Sums up a function over its modes here.
    pub fn sum_up(&mut self, regime: &Regime, place: usize) {
        let own = &mut self.own[place];
        own.summed_up_at = self.tau;
        let groups = self.size.len();
        let (now_re, now_im) = self.now.split_at(groups);
        let (moved_re, moved_im) = self.moved[..2 * groups].split_at(groups);
        let weights = &regime.functionals[place].weights[..groups];
        if own.measurement != self.measurements {
            own.measurement = self.measurements;
            own.sum_up_sizes(weights, &self.size);
        }
        let slots = &mut own.partial[1..=groups];
        let mut sums = [Lane::ZERO; 4];
        let (mut value, mut size) = (Lane::ZERO, Lane::ZERO);
        for group in 0..groups {
            let weights = &weights[group];
            let (re, im) = (now_re[group], now_im[group]);
            for (order, sum) in sums.iter_mut().enumerate() {
                *sum += weights.re[order] * re - weights.im[order] * im;
            }
            slots[group] = sums;
            let (re, im) = (moved_re[group], moved_im[group]);
            value += weights.re[0] * re - weights.im[0] * im;
            size += weights.size[0] * (re.abs() + im.abs());
        }
        own.evaluate(self.tau);
        own.value += value.reduce_add();
        own.size += size.reduce_add();
        own.amplitudes = sums.map(Lane::reduce_add);
    }

    /// Whether a function is known to keep its limits until a time after the start, s.
    pub fn is_safe(&self, place: usize, until: f64) -> bool {
        self.own[place].safe_until >= until
    }

    /// Notes that a function keeps its limits until a time after the start, s.
    pub fn note_safe(&mut self, place: usize, until: f64) {
        self.own[place].safe_until = until;
    }

    /// Whether a function has been summed up here.
    pub fn is_summed_up(&self, place: usize) -> bool {
        self.own[place].summed_up_at == self.tau
    }

    /// Whether a function that has been summed up here is certainly between two limits.
    pub fn is_between(&self, place: usize, low: f64, high: f64) -> bool {
        let value = self.own[place].value;
        self.clusters.is_empty() && low < value && value < high
    }

    /// Value and derivatives of a function that has been summed up here, with bounds over
    /// the next step of `rung`.
    pub fn local(&self, regime: &Regime, place: usize, rung: &Rung) -> Local {
        let own = &self.own[place];
        let mut derivatives = own.amplitudes;
        for (slot, value) in derivatives[1..].iter_mut().zip(own.derivatives) {
            *slot += value;
        }
        let all = own.all;
        let (mut fast, mut fast_rate) = (0.0, 0.0);
        let mut fourth = all[2];
        derivatives[0] = own.value;
        if rung.slow < regime.modes.count() {
            let (group, lane) = (rung.slow / 4, rung.slow % 4);
            // Without the fast modes, at whatever phase they are.
            let left_out = beyond(&own.partial[group..], lane);
            for (slot, sum) in derivatives.iter_mut().zip(left_out) {
                *slot -= sum;
            }
            // With the rounding of the sums.
            let sizes = beyond(&own.sizes[group..], lane);
            fast = (sizes[0] + ROUNDING * all[0]) * rung.growth;
            fast_rate = (sizes[1] + ROUNDING * all[1]) * rung.growth;
            fourth -= sizes[2];
        }
        let mut local = Local {
            derivatives,
            fourth: fourth * rung.growth + own.fourth,
            fast,
            fast_rate,
            noise: own.size,
            rate_noise: all[1] + own.derivatives[0].abs() + own.rate_size,
            drift_noise: own.rate_size,
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
        local.drift_noise *= ROUNDING;
        local
    }

    /// The state here.
    pub fn state(&mut self, regime: &Regime, out: &mut [f64]) {
        let modes = self.now.len();
        regime
            .integrals
            .moved(&self.series, self.tau, &mut self.moved[modes..]);
        self.sum.clone_from(&self.origin);
        regime
            .states
            .add_product(numbers(&self.moved), &mut self.sum);
        let states = out.len();
        out.copy_from_slice(&numbers(&self.sum)[..states]);
        for (flow, cluster) in self.clusters.iter().zip(&regime.clusters) {
            flow.add_state(cluster, &regime.system.phases, self.tau, out);
        }
    }
}

/// out - factor column.
fn subtract(column: &[Lane], factor: f64, out: &mut [Lane]) {
    let factor = Lane::splat(factor);
    for (slot, entry) in out.iter_mut().zip(column) {
        *slot -= *entry * factor;
    }
}

impl Own {
    fn sum_up_sizes(&mut self, weights: &[Weights], sizes: &[Lane]) {
        let mut sums = [Lane::ZERO; 3];
        for ((weights, size), slot) in weights.iter().zip(sizes).zip(&mut self.sizes[1..]) {
            for (sum, weight) in sums.iter_mut().zip(weights.size) {
                *sum += weight * *size;
            }
            *slot = sums;
        }
        self.all = sums.map(Lane::reduce_add);
    }

    /// The part of the integrals, as a polynomial in tau.
    fn find_polynomial(&mut self, regime: &Regime, functional: &Functional, derivatives: &[Lane]) {
        let polynomial = &mut self.polynomial;
        polynomial.clear();
        self.fourth = 0.0;
        if functional.integrals.is_empty() {
            return;
        }
        let width = regime.integrals.groups();
        let mut factor = 1.0;
        for (order, derivative) in derivatives.chunks_exact(width).enumerate() {
            factor *= reciprocal(order + 1);
            let terms = functional.integrals.iter().zip(numbers(derivative));
            polynomial.push(factor * terms.map(|(a, b)| a * b).sum::<f64>());
        }
        let window = regime.ladder.window;
        let (mut power, mut largest, mut needed) = (1.0, 0.0_f64, 0);
        for (order, coefficient) in polynomial.iter().enumerate() {
            power *= window;
            let size = coefficient.abs() * power;
            if size > NEGLIGIBLE * largest || size.is_nan() {
                needed = order + 1;
            }
            largest = largest.max(size);
        }
        polynomial.truncate(needed);
        power = 1.0;
        for (place, coefficient) in polynomial.iter().enumerate().skip(3) {
            // The fourth derivative of tau^k, k = place + 1.
            let falling = (place + 1) * place * (place - 1) * (place - 2);
            self.fourth += coefficient.abs() * falling as f64 * power;
            power *= window;
        }
    }

    /// The polynomial and the start with three derivatives, by Horner's scheme.
    fn evaluate(&mut self, tau: f64) {
        let [mut a, mut b, mut c, mut d, mut size] = [0.0; 5];
        for coefficient in self.polynomial.iter().rev() {
            size = size * tau + coefficient.abs();
            d = d * tau + c;
            c = c * tau + b;
            b = b * tau + a;
            a = a * tau + coefficient;
        }
        // a is the polynomial over tau.
        self.value = self.start + a * tau;
        self.size = self.start_size + (size + self.rate_size) * tau;
        self.derivatives = [a + b * tau, 2.0 * (b + c * tau), 6.0 * (c + d * tau)];
    }
}
