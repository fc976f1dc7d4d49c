//! A point of a motion.

/// Changes of the length of a step by rounding of its end, relative to the length, that count: smaller ones are below the
/// errors of a step, and with larger ones a refused step would not shrink to 0.9 of its length.
const COUNTED_ROUNDINGS: std::ops::Range<f64> = 1e-11..0.1;

/// A state and its time.
#[derive(Clone, Debug)]
pub struct Point {
    /// Time, s.
    pub t: f64,
    /// State.
    pub y: Vec<f64>,
}

impl Point {
    /// Returns the length (s) of the next step, `step` s or up to the time `until` (s), and whether `until` cuts it short.
    pub fn choose_length(&self, step: f64, until: f64) -> (f64, bool) {
        let (limit, step) = (until - self.t, self.exact_length(step));
        match limit <= step {
            true => (limit, true),
            false => (step, false),
        }
    }

    /// Returns the length (s) of a step from here that is nearest to `length` and ends at a time without rounding, if the
    /// rounding counts. If the state advanced by another length than the time, their difference would grow with the
    /// magnitude of the time.
    pub fn exact_length(&self, length: f64) -> f64 {
        let exact = (self.t + length) - self.t;
        match COUNTED_ROUNDINGS.contains(&((exact - length) / length).abs()) {
            true => exact,
            false => length,
        }
    }
}
