//! A point of a motion.

/// Relative changes of a step size, by rounding of its end time, that are corrected. Smaller changes are below
/// the error of a step. With larger ones, a rejected step would not shrink to 0.9 of its length.
const CORRECTED_ROUNDINGS: std::ops::Range<f64> = 1e-11..0.1;

/// A state and its time.
#[derive(Clone, Debug)]
pub struct Point {
    /// Time, s.
    pub t: f64,
    /// State.
    pub y: Vec<f64>,
}

impl Point {
    /// Returns the length (s) of the next step and whether `until` cuts it short. The length is `step` s, or
    /// less if `until` (s) is nearer.
    pub fn choose_length(&self, step: f64, until: f64) -> (f64, bool) {
        let (limit, step) = (until - self.t, self.exact_length(step));
        match limit <= step {
            true => (limit, true),
            false => (step, false),
        }
    }

    /// Returns the length (s) of a step from this point that is nearest to `length` and ends at a representable
    /// time, if the rounding matters. Otherwise rounding of the time would make the state and the time advance
    /// differently, by more for larger times.
    pub fn exact_length(&self, length: f64) -> f64 {
        let exact = (self.t + length) - self.t;
        match CORRECTED_ROUNDINGS.contains(&((exact - length) / length).abs()) {
            true => exact,
            false => length,
        }
    }
}
