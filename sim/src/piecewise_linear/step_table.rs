//! Steps of fixed lengths, each half as long as the preceding one, with the expm1 of every mode over each step.
//! A search then advances the modes by multiplications.

use super::modes::Modes;
use super::simd_vectors::SplitComplex;

/// Length of the longest step, times the fastest rate.
const LONGEST_STEP: f64 = 1024.0;

/// Length of the shortest step, times the fastest rate.
const SHORTEST_STEP: f64 = 1.0 / 65536.0;

/// Largest angle of a slow mode in a step, rad. Faster modes are bounded by their amplitudes.
const MAX_TURN_RAD: f64 = 2.5;

/// A step of one length.
#[derive(Clone, Debug)]
pub(super) struct Step {
    /// Length of the step, s.
    pub length: f64,
    /// exp(rate length) - 1 of each mode.
    pub expm1: SplitComplex,
    /// Largest growth of a mode within the step, at least 1.
    pub growth: f64,
    /// Number of modes that turn little within the step; they are the first ones.
    pub slow: usize,
}

/// Minimum number of steps if no mode limits their length.
const MIN_STEPS: usize = 25;

/// Steps from the longest to the shortest.
#[derive(Clone, Debug)]
pub(super) struct StepTable {
    pub steps: Vec<Step>,
    /// Largest time since the start of a regime that a step may reach, s.
    pub window: f64,
    /// exp(rate window) - 1 of each mode.
    pub through: SplitComplex,
}

impl StepTable {
    /// Returns the length of the longest step for this fastest rate, s.
    pub fn longest(fastest: f64) -> f64 {
        if fastest > 0.0 {
            (LONGEST_STEP / fastest).min(1e6)
        } else {
            1.0
        }
    }

    /// Creates the steps for these modes.
    pub fn new(modes: &Modes, window: f64, fastest: f64) -> Self {
        // A power of two makes sums of steps exact.
        let mut length = window.log2().floor().exp2();
        let mut steps = Vec::new();
        while steps.len() < MIN_STEPS || (length * fastest > SHORTEST_STEP && steps.len() < 80) {
            steps.push(Step::new(modes, length));
            length *= 0.5;
        }
        Self {
            steps,
            window,
            through: SplitComplex::expm1(&modes.rate, window),
        }
    }
}

impl Step {
    fn new(modes: &Modes, length: f64) -> Self {
        let growth = modes
            .rate
            .iter()
            .map(|rate| (rate.re * length).exp())
            .fold(1.0, f64::max);
        let slow = modes
            .magnitude
            .partition_point(|rate| rate * length <= MAX_TURN_RAD);
        Self {
            length,
            expm1: SplitComplex::expm1(&modes.rate, length),
            growth,
            slow,
        }
    }
}
