//! A function in one flow: its terms, its value and derivatives at the present time, and its bounds
//! within a step.

use fearless_simd::Simd;

use super::event_function::EventFunction;
use super::kernels::{self, Factors};
use super::simd_vectors::SimdVector;
use super::step_table::Step;

/// The roundings of a few operations on a number of size 1.
pub(super) const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A function in one flow.
#[derive(Clone, Debug, Default)]
pub(super) struct EventEvaluation {
    /// It keeps its limits until then, s after the start.
    pub safe_until: f64,
    /// Time since the start of the last summation, s.
    pub summed_up_at: f64,
    /// The value at the start.
    start: f64,
    /// The sum of its terms' magnitudes.
    start_size: f64,
    /// Contribution of each power of time to the value and the derivatives of order 1 to 3.
    terms: Vec<SimdVector>,
    /// The sum of the magnitudes of the terms of the rate at the start, which may cancel.
    rate_size: f64,
    /// A bound of the polynomial's fourth derivative within the window.
    fourth: f64,
    /// The value, and the sum of the magnitudes of its terms.
    pub value: f64,
    pub size: f64,
    /// Derivatives of order 1 to 3 at the places of their orders.
    derivatives: SimdVector,
    /// The polynomial's part of the first one.
    polynomial_rate: f64,
    /// The parts of the modes before each, and of all: of the amplitudes in the value, and of
    /// the derivatives of order 1 to 3.
    before: Vec<SimdVector>,
    /// Their magnitudes in the orders 0, 1, 4 and 2, and of which measurement.
    sizes_before: Vec<SimdVector>,
    measurement: u64,
    /// Errors of value and rate at the start while the function leaves a limit that held it.
    pub slack: Option<[f64; 2]>,
}

/// Value and derivatives of a function at the present time of a flow, with bounds.
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
    /// A bound of the fast modes' contribution to the second derivative.
    pub fast_second: f64,
    /// The fast modes' contribution to the value here.
    pub fast_here: f64,
    /// Rounding error of the value.
    pub noise: f64,
    /// Rounding error of the first derivative.
    pub rate_noise: f64,
    /// The part of it that adds to the value in proportion to time.
    pub drift_noise: f64,
}

impl EventEvaluation {
    /// Prepares for a flow from a start, given the known quantities there and the causes of the
    /// integrals' rates. `coefficients` is scratch memory.
    #[inline(always)]
    pub fn start<S: Simd>(
        &mut self,
        simd: S,
        event_function: &EventFunction,
        given: &[f64],
        causes: &[f64],
        coefficients: &mut Vec<SimdVector>,
    ) {
        let sums = event_function.weights.len() + 1;
        self.before.resize(sums, SimdVector::ZERO);
        self.sizes_before.resize(sums, SimdVector::ZERO);
        self.safe_until = f64::NEG_INFINITY;
        self.summed_up_at = f64::NAN;
        self.slack = None;
        (self.start, self.start_size) = event_function.evaluate(given);
        let polynomial = &event_function.polynomial;
        self.rate_size = polynomial.rate_size(causes);
        self.fourth = polynomial.terms(simd, causes, coefficients, &mut self.terms);
    }

    /// Takes the magnitudes of the modes' amplitudes, if they are new: those of this
    /// measurement.
    #[inline(always)]
    pub fn take_sizes<S: Simd>(
        &mut self,
        simd: S,
        event_function: &EventFunction,
        sizes: &[SimdVector],
        measurement: u64,
    ) {
        if self.measurement != measurement {
            self.measurement = measurement;
            kernels::sum_sizes(simd, &event_function.weights, sizes, &mut self.sizes_before);
        }
    }

    /// Sums up, so long after the start, s, given the amplitudes, how far they have moved, and
    /// the powers of the time.
    #[inline(always)]
    pub fn sum_up<S: Simd>(
        &mut self,
        simd: S,
        event_function: &EventFunction,
        amplitudes: (&[SimdVector], &[SimdVector]),
        (tau, powers): (f64, &[f64]),
    ) {
        self.summed_up_at = tau;
        let factors = Factors {
            weights: &event_function.weights,
            value_weights: &event_function.value_weights,
            terms: &self.terms,
        };
        let summed = kernels::sum_up(simd, factors, amplitudes, powers, &mut self.before);
        self.value = self.start + summed.value;
        self.size = self.start_size + self.rate_size * tau + summed.size;
        self.derivatives = summed.derivatives;
        self.polynomial_rate = summed.polynomial_rate;
    }

    /// Value and derivatives without the clusters' parts, with bounds over the next step of
    /// `step`.
    #[inline(always)]
    pub fn local(&self, step: &Step) -> Local {
        let modes = self.before.len() - 1;
        let slow = step.slow.min(modes);
        // Without the fast modes, at whatever phase they are.
        let left_out = self.before[modes] - self.before[slow];
        let all = self.sizes_before[modes];
        let sizes = (all - self.sizes_before[slow]).to_array();
        let all = all.to_array();
        let mut derivatives = (self.derivatives - left_out).to_array();
        let left_out = left_out.to_array();
        derivatives[0] = self.value - left_out[0];
        let (mut fast, mut fast_rate, mut fast_second) = (0.0, 0.0, 0.0);
        if slow < modes {
            // With the rounding of the sums.
            fast = (sizes[0] + ROUNDING * all[0]) * step.growth;
            fast_rate = (sizes[1] + ROUNDING * all[1]) * step.growth;
            fast_second = (sizes[3] + ROUNDING * all[3]) * step.growth;
        }
        let fourth = all[2] - sizes[2];
        Local {
            derivatives,
            fourth: fourth * step.growth + self.fourth,
            fast,
            fast_rate,
            fast_second,
            fast_here: left_out[0],
            noise: ROUNDING * self.size,
            rate_noise: ROUNDING * (all[1] + self.polynomial_rate.abs() + self.rate_size),
            drift_noise: ROUNDING * self.rate_size,
        }
    }
}
