//! Motion within one regime: its displacement at a time tau since the start.
//!
//! All sums are differences from the start. A motion that has hardly moved is then as accurate as its start,
//! even if it consists of modes whose amplitudes are thousands of times larger and nearly cancel. A flow
//! advances by a step of the step table or by any time. It returns the values and derivatives of the regime's
//! functions and the state at its current time.

use fearless_simd::Simd;

use crate::registers::dispatch_registers;
use nalgebra::Complex;

use super::cluster_flow::ClusterFlow;
use super::event_evaluation::{EventEvaluation, Local, ROUNDING};
use super::kernels::{self, Amplitudes};
use super::regime::Regime;
use super::simd_vectors::{
    MAX_SMALL_ARGUMENT, SimdVector, SplitComplex, numbers, numbers_mut, simd_vectors,
    terms_of_expm1,
};
use super::step_table::Step;

/// Largest time by which amplitudes are computed backwards, in units of the shortest decay time, because this
/// magnifies their rounding errors.
const MAX_DECAY_TIMES_BACK: f64 = 1.0;

/// Change of the logarithm of the fastest decaying amplitude after which the magnitudes are computed again.
const MAX_LOG_DECAY: f64 = 0.25;

/// Error of a rate that is zero at the release of a motion, in rounding errors of all its terms. The time of
/// the release has this accuracy.
const DEPARTURE_ROUNDINGS: f64 = 16.0;

/// Distance, in rounding errors, at which a function has left its limit.
const DEPARTED_ROUNDINGS: f64 = 4.0;

/// Motion in one regime. Its memory is reused for the next motion.
#[derive(Clone, Debug, Default)]
pub(super) struct Flow {
    /// Time since the start, s.
    pub tau: f64,
    /// Initial values: the state, a unit constant, the inputs, and sine and cosine of each phase.
    given: Vec<f64>,
    /// Coordinates at the start, in the layout of [`Regime`].
    start: Vec<SimdVector>,
    /// Displacements of the coordinates.
    moved: Vec<SimdVector>,
    /// Amplitudes of the modes at `tau`.
    now: Vec<SimdVector>,
    /// Magnitudes of the amplitudes, the time at which they were measured, s, and the number of measurements.
    size: Vec<SimdVector>,
    measured_at: f64,
    measurements: u64,
    /// Causes of the integrals, and the motion that they cause, which is computed on first use.
    causes: Vec<f64>,
    motion: Vec<SimdVector>,
    /// Coefficients of the last polynomial.
    coefficients: Vec<SimdVector>,
    /// Powers of a time from the power 0 on, this time, and the number of powers needed at near times and at
    /// all times.
    powers: Vec<f64>,
    powers_of: f64,
    power_counts: [usize; 2],
    evaluations: Vec<EventEvaluation>,
    /// True if a function is leaving a limit that held it.
    departs: bool,
    clusters: Vec<ClusterFlow>,
    /// Scratch memory for the state.
    sum: Vec<SimdVector>,
}

impl Flow {
    /// Starts at a state, with exp(i theta) of the phases at that time.
    #[inline(always)]
    pub fn start<S: Simd>(
        &mut self,
        simd: S,
        regime: &Regime,
        state: &[f64],
        inputs: &[f64],
        phases: &[Complex<f64>],
    ) {
        self.tau = 0.0;
        self.measured_at = f64::NAN;
        self.given.clear();
        self.given.extend_from_slice(state);
        self.given.push(1.0);
        self.given.extend_from_slice(inputs);
        let units = regime.modes.rest.len();
        self.given.resize(state.len() + units, 0.0);
        self.given.extend(phases.iter().flat_map(|e| [e.im, e.re]));
        self.start.clear();
        let modes = 2 * regime.modes.simd_vectors();
        self.start
            .resize(modes + regime.integrals.simd_vectors(), SimdVector::ZERO);
        regime
            .coordinates
            .add_product(simd, &self.given, &mut self.start);
        self.rewind(regime);
        let units = &self.given[state.len()..state.len() + units];
        regime
            .integrals
            .causes(&self.start[modes..], units, phases, &mut self.causes);
        self.motion.clear();
        self.clusters.clear();
        for cluster in &regime.clusters {
            self.clusters
                .push(ClusterFlow::new(cluster, state, inputs, phases));
        }
        self.evaluations
            .resize_with(regime.event_functions.len(), EventEvaluation::default);
        self.departs = false;
        self.power_counts = [0; 2];
        self.powers_of = f64::NAN;
        for (evaluation, event_function) in self.evaluations.iter_mut().zip(&regime.event_functions)
        {
            evaluation.start(
                simd,
                event_function,
                &self.given,
                &self.causes,
                &mut self.coefficients,
            );
            let counts = self.power_counts.iter_mut();
            for (slot, count) in counts.zip(event_function.polynomial.powers()) {
                *slot = count.max(*slot);
            }
        }
        self.measure_amplitudes(simd, regime);
    }

    /// Resets the flow to its start.
    fn rewind(&mut self, regime: &Regime) {
        self.moved.clear();
        self.moved.resize(self.start.len(), SimdVector::ZERO);
        self.now.clear();
        self.now
            .extend_from_slice(&self.start[..2 * regime.modes.simd_vectors()]);
    }

    /// Advances the modes, given their expm1 over the duration.
    #[inline(always)]
    fn advance<S: Simd>(&mut self, simd: S, expm1: &SplitComplex) {
        kernels::advance(simd, expm1, self.amplitudes());
    }

    /// Advances by a step of the step table.
    #[inline(always)]
    pub fn step<S: Simd>(&mut self, simd: S, regime: &Regime, step: &Step) {
        self.tau += step.length;
        self.advance(simd, &step.expm1);
        self.measure_amplitudes(simd, regime);
    }

    /// Advances by any time, which may be negative.
    #[inline(always)]
    pub fn shift<S: Simd>(&mut self, simd: S, regime: &Regime, time: f64) {
        if -time * regime.modes.damping > MAX_DECAY_TIMES_BACK {
            // Restarts from the start: an amplitude that decayed below its rounding error would grow back from
            // this error.
            let tau = self.tau + time;
            self.rewind(regime);
            self.tau = 0.0;
            self.advance_by(simd, regime, tau);
        } else {
            self.advance_by(simd, regime, time);
        }
        self.measure_amplitudes(simd, regime);
    }

    #[inline(always)]
    fn advance_by<S: Simd>(&mut self, simd: S, regime: &Regime, time: f64) {
        self.tau += time;
        let fastest = regime.modes.magnitude.last().copied().unwrap_or(0.0);
        let mut rest = time;
        for step in &regime.step_table.steps {
            if fastest * rest.abs() <= MAX_SMALL_ARGUMENT || rest <= 0.0 {
                break;
            }
            if step.length <= rest {
                self.advance(simd, &step.expm1);
                rest -= step.length;
            }
        }
        if fastest * rest.abs() <= MAX_SMALL_ARGUMENT {
            self.advance_little(simd, &regime.modes.rates, rest, fastest);
        } else {
            self.advance(simd, &SplitComplex::expm1(&regime.modes.rate, rest));
        }
    }

    /// Advances by a time so short that a short series gives the expm1.
    #[inline(always)]
    fn advance_little<S: Simd>(&mut self, simd: S, rates: &SplitComplex, time: f64, fastest: f64) {
        let terms = terms_of_expm1(fastest * time.abs());
        kernels::advance_little(simd, rates, time, terms, self.amplitudes());
    }

    fn amplitudes(&mut self) -> Amplitudes<'_> {
        Amplitudes {
            start: &self.start,
            moved: &mut self.moved,
            now: &mut self.now,
        }
    }

    /// Writes the state at a time since the start, s.
    pub fn state_at(&mut self, regime: &Regime, tau: f64, out: &mut [f64]) {
        dispatch_registers!(simd => {
            self.advance_to(simd, regime, tau);
            self.state(simd, regime, out);
        });
    }

    /// Returns from a state that overflowed to the last time with a finite state, and writes this state.
    #[cold]
    pub fn return_to_finite_state(&mut self, regime: &Regime, out: &mut [f64]) {
        let (mut finite, mut infinite) = (0.0, self.tau);
        loop {
            let middle = 0.5 * (finite + infinite);
            if middle <= finite || middle >= infinite {
                break;
            }
            self.state_at(regime, middle, out);
            match out.iter().all(|entry| entry.is_finite()) {
                true => finite = middle,
                false => infinite = middle,
            }
        }
        self.state_at(regime, finite, out);
    }

    /// Advances to a time since the start at which only the state is needed.
    #[inline(always)]
    pub fn advance_to<S: Simd>(&mut self, simd: S, regime: &Regime, tau: f64) {
        self.rewind(regime);
        self.tau = 0.0;
        if tau == regime.step_table.window {
            self.tau = tau;
            self.advance(simd, &regime.step_table.through);
        } else {
            self.advance_by(simd, regime, tau);
        }
    }

    /// Returns true if no amplitude has overflowed.
    pub fn is_finite(&self) -> bool {
        let evaluation = self.evaluations.iter();
        let values = evaluation.flat_map(|evaluation| [evaluation.value, evaluation.size]);
        let sizes = self.size.iter().flat_map(|size| size.to_array());
        values.chain(sizes).all(|value| value.is_finite())
    }

    /// Computes the magnitudes of the amplitudes again if they may have decreased considerably.
    #[inline(always)]
    fn measure_amplitudes<S: Simd>(&mut self, simd: S, regime: &Regime) {
        let decayed = (self.tau - self.measured_at) * regime.modes.damping;
        if (0.0..MAX_LOG_DECAY).contains(&decayed) {
            return;
        }
        self.measured_at = self.tau;
        let (re, im) = self.now.split_at(self.now.len() / 2);
        self.measurements += 1;
        self.size.resize(re.len(), SimdVector::ZERO);
        kernels::magnitudes(simd, re, im, &mut self.size);
    }

    /// Computes the needed powers of tau, an even number of them.
    #[inline(always)]
    fn compute_powers(&mut self, regime: &Regime) {
        if self.powers_of == self.tau {
            return;
        }
        self.powers_of = self.tau;
        let near = regime.integrals.is_near(self.tau);
        let pairs = self.power_counts[usize::from(!near)].div_ceil(2);
        self.powers.resize(2 * pairs, 0.0);
        let (squared, mut even, mut odd) = (self.tau * self.tau, 1.0, self.tau);
        for pair in self.powers.chunks_exact_mut(2) {
            pair.copy_from_slice(&[even, odd]);
            (even, odd) = (even * squared, odd * squared);
        }
    }

    /// Evaluates a function at the current time.
    #[inline(always)]
    pub fn evaluate_function<S: Simd>(&mut self, simd: S, regime: &Regime, index: usize) {
        self.compute_powers(regime);
        let evaluation = &mut self.evaluations[index];
        let event_function = &regime.event_functions[index];
        evaluation.update_sizes(simd, event_function, &self.size, self.measurements);
        evaluation.evaluate_function(
            simd,
            event_function,
            (&self.now, &self.moved),
            (self.tau, &self.powers),
        );
    }

    /// Returns the rounding error of the rate of a function at the start, including cancelled
    /// terms.
    pub fn start_rate_noise(&self, regime: &Regime, index: usize) -> f64 {
        ROUNDING * regime.event_functions[index].rate_size(&self.given)
    }

    /// Starts the departure of a function from a limit that held it, where its value and rate are rounding
    /// errors. Does nothing if the rate exceeds its rounding error.
    pub fn start_departure<S: Simd>(&mut self, simd: S, regime: &Regime, index: usize) {
        let Some(step) = regime.step_table.steps.last() else {
            return;
        };
        self.evaluate_function(simd, regime, index);
        let [value, rate] = self.local(regime, index, step, |local| {
            [local.derivatives[0], local.derivatives[1]]
        });
        let limits = regime.event_functions[index].limits;
        let (above, below) = ((value - limits.low).abs(), (limits.high - value).abs());
        let inward = if above <= below { rate } else { -rate };
        let noise = DEPARTURE_ROUNDINGS * self.start_rate_noise(regime, index);
        if inward <= noise {
            let distance = above.min(below);
            self.continue_departure(index, [2.0 * distance, 2.0 * rate.abs() + noise]);
        }
    }

    /// Continues the departure of a function whose value and rate have these errors at the start.
    pub fn continue_departure(&mut self, index: usize, errors: [f64; 2]) {
        self.evaluations[index].slack = Some(errors);
        self.departs = true;
    }

    /// Returns the errors of value and rate at the current time of a function that is still leaving a limit.
    pub fn departure_errors(&self, index: usize) -> Option<[f64; 2]> {
        let [value, rate] = self.evaluations[index].slack?;
        Some([value + rate * self.tau, rate])
    }

    /// Ends the departures of functions whose distance from their limits exceeds the effect of rounding at the
    /// start.
    #[inline(always)]
    pub fn end_departures<S: Simd>(&mut self, simd: S, regime: &Regime) {
        if !self.departs {
            return;
        }
        for index in 0..self.evaluations.len() {
            let Some([value, rate]) = self.evaluations[index].slack else {
                continue;
            };
            self.evaluate_function(simd, regime, index);
            let limits = regime.event_functions[index].limits;
            let now = self.evaluations[index].value;
            let distance = (now - limits.low).abs().min((limits.high - now).abs());
            if distance > DEPARTED_ROUNDINGS * (value + rate * self.tau) {
                self.evaluations[index].slack = None;
            }
        }
        self.departs = self
            .evaluations
            .iter()
            .any(|evaluation| evaluation.slack.is_some());
    }

    /// Returns true if a function is known to stay within its limits until a time since the start, s.
    pub fn is_safe(&self, index: usize, until: f64) -> bool {
        self.evaluations[index].safe_until >= until
    }

    /// Records that a function stays within its limits until a time since the start, s.
    pub fn record_safe_time(&mut self, index: usize, until: f64) {
        self.evaluations[index].safe_until = until;
    }

    /// Returns true if a function has been evaluated at the current time.
    pub fn is_evaluated(&self, index: usize) -> bool {
        self.evaluations[index].evaluated_at == self.tau
    }

    /// Returns true if an evaluated function is certainly between two limits.
    pub fn is_between(&self, index: usize, low: f64, high: f64) -> bool {
        let value = self.evaluations[index].value;
        self.clusters.is_empty() && low < value && value < high
    }

    /// Applies a closure to value and derivatives of an evaluated function, with bounds over the next step of
    /// `step`. The closure allows the compiler to keep them in registers.
    #[inline(always)]
    pub fn local<T>(
        &self,
        regime: &Regime,
        index: usize,
        step: &Step,
        make: impl Fn(&Local) -> T,
    ) -> T {
        let local = self.evaluations[index].local(step);
        if self.clusters.is_empty() && !self.departs {
            make(&local)
        } else {
            make(&self.add_clusters(local, regime, index, step))
        }
    }

    /// Adds the contributions of the clusters and the error after a departure.
    #[cold]
    fn add_clusters(&self, mut local: Local, regime: &Regime, index: usize, step: &Step) -> Local {
        if let Some([value, rate]) = self.evaluations[index].slack {
            local.noise += value + rate * self.tau;
            local.rate_noise += rate;
            local.drift_noise += rate;
        }
        let phases = &regime.system.phases;
        let span = (self.tau, step.length);
        let powers = &regime.event_functions[index].cluster_powers;
        for ((flow, cluster), powers) in self.clusters.iter().zip(&regime.clusters).zip(powers) {
            flow.add_to(cluster, powers, phases, span, &mut local);
        }
        local
    }

    /// Writes the state at the current time.
    #[inline(always)]
    pub fn state<S: Simd>(&mut self, simd: S, regime: &Regime, out: &mut [f64]) {
        let modes = self.now.len();
        let integrals = &regime.integrals;
        if self.motion.is_empty() {
            integrals.motion(simd, &self.causes, &mut self.motion);
        }
        integrals.moved_by(simd, &self.motion, self.tau, &mut self.moved[modes..]);
        let states = out.len();
        self.sum.clear();
        self.sum.resize(simd_vectors(states), SimdVector::ZERO);
        numbers_mut(&mut self.sum)[..states].copy_from_slice(&self.given[..states]);
        regime
            .states
            .add_product(simd, numbers(&self.moved), &mut self.sum);
        out.copy_from_slice(&numbers(&self.sum)[..states]);
        for (flow, cluster) in self.clusters.iter().zip(&regime.clusters) {
            flow.add_state(cluster, &regime.system.phases, self.tau, out);
        }
    }
}
