//! Event function in one flow: its terms, its value and derivatives at the current time, and its bounds within
//! a step.

use fearless_simd::Simd;

use super::event_function::EventFunction;
use super::kernels::{self, Factors};
use super::simd_vectors::SimdVector;
use super::step_table::Step;

/// Rounding error of a few operations on a number of magnitude 1.
pub(super) const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Event function in one flow.
#[derive(Clone, Debug, Default)]
pub(super) struct EventEvaluation {
    /// Time since the start until which the function stays within its limits, s.
    pub safe_until: f64,
    /// Time since the start at which the function was evaluated last, s.
    pub evaluated_at: f64,
    /// Value at the start.
    start: f64,
    /// Sum of the magnitudes of the terms of the value at the start.
    start_size: f64,
    /// Contribution of each power of time to the value and the derivatives of order 1 to 3.
    terms: Vec<SimdVector>,
    /// Sum of the magnitudes of the terms of the rate at the start, which may cancel.
    rate_size: f64,
    /// Bound of the polynomial's fourth derivative within the window.
    fourth: f64,
    /// Value, and sum of the magnitudes of its terms.
    pub value: f64,
    pub size: f64,
    /// Derivatives of order 1 to 3, each at the index of its order.
    derivatives: SimdVector,
    /// Contribution of the polynomial to the first derivative.
    polynomial_rate: f64,
    /// Cumulative sums over the modes: contribution of the amplitudes to the value and to the derivatives of
    /// order 1 to 3.
    before: Vec<SimdVector>,
    /// Cumulative sums of the magnitudes of these contributions in the orders 0, 1, 4 and 2, and the number of
    /// the measurement of amplitudes that they belong to.
    sizes_before: Vec<SimdVector>,
    measurement: u64,
    /// Errors of value and rate at the start while the function leaves a limit that held it.
    pub slack: Option<[f64; 2]>,
}

/// Value and derivatives of a function at the current time of a flow, with bounds.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Local {
    /// Value and derivatives of order 1 to 3; contributions of the slow modes only.
    pub derivatives: [f64; 4],
    /// Bound of the magnitude of the fourth derivative of the slow modes.
    pub fourth: f64,
    /// Bound of the fast modes' contribution to the value.
    pub fast: f64,
    /// Bound of the fast modes' contribution to the first derivative.
    pub fast_rate: f64,
    /// Bound of the fast modes' contribution to the second derivative.
    pub fast_second: f64,
    /// Contribution of the fast modes to the value at the current time.
    pub fast_here: f64,
    /// Rounding error of the value.
    pub noise: f64,
    /// Rounding error of the first derivative.
    pub rate_noise: f64,
    /// Rounding error per time, which adds to the value in proportion to time.
    pub drift_noise: f64,
}

impl EventEvaluation {
    /// Prepares the function for a flow, given the state and forces at its start and the causes of the
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
        self.evaluated_at = f64::NAN;
        self.slack = None;
        (self.start, self.start_size) = event_function.evaluate(given);
        let polynomial = &event_function.polynomial;
        self.rate_size = polynomial.rate_size(causes);
        self.fourth = polynomial.terms(simd, causes, coefficients, &mut self.terms);
    }

    /// Updates the sums of magnitudes if the magnitudes of the amplitudes have been measured again.
    #[inline(always)]
    pub fn update_sizes<S: Simd>(
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

    /// Evaluates the function at a time since the start, s, given the amplitudes, their displacements, and the
    /// powers of the time.
    #[inline(always)]
    pub fn evaluate_function<S: Simd>(
        &mut self,
        simd: S,
        event_function: &EventFunction,
        amplitudes: (&[SimdVector], &[SimdVector]),
        (tau, powers): (f64, &[f64]),
    ) {
        self.evaluated_at = tau;
        let factors = Factors {
            weights: &event_function.weights,
            value_weights: &event_function.value_weights,
            terms: &self.terms,
        };
        let summed =
            kernels::evaluate_function(simd, factors, amplitudes, powers, &mut self.before);
        self.value = self.start + summed.value;
        self.size = self.start_size + self.rate_size * tau + summed.size;
        self.derivatives = summed.derivatives;
        self.polynomial_rate = summed.polynomial_rate;
    }

    /// Returns value and derivatives without the contributions of clusters, with bounds over the next step of
    /// `step`.
    #[inline(always)]
    pub fn local(&self, step: &Step) -> Local {
        let modes = self.before.len() - 1;
        let slow = step.slow.min(modes);
        // The contribution of the fast modes at their current phase is subtracted.
        let left_out = self.before[modes] - self.before[slow];
        let all = self.sizes_before[modes];
        let sizes = (all - self.sizes_before[slow]).to_array();
        let all = all.to_array();
        let mut derivatives = (self.derivatives - left_out).to_array();
        let left_out = left_out.to_array();
        derivatives[0] = self.value - left_out[0];
        let (mut fast, mut fast_rate, mut fast_second) = (0.0, 0.0, 0.0);
        if slow < modes {
            // Includes the rounding error of the sums.
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
