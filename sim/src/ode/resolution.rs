//! Step sizes that resolve the switching functions.
//!
//! The error of a step is zero if no state changes, whatever the length of the step. Within such a step a
//! static friction force, or a function of time that switches a force, may cross its bound and return
//! undetected. Therefore the switching functions limit the step as well: a parabola through the values at both
//! ends and in the middle must predict the values at the quarters. Larger deviations are allowed only if they
//! cannot hide a sign change.

/// Largest deviation from the parabola, as a fraction of the function's range in the step.
const MAX_DEVIATION_FRACTION: f64 = 0.1;

/// A sign change is possible if the lowest value is at most this multiple of the deviation.
const HIDDEN_CHANGE_FACTOR: f64 = 2.0;

/// A function can reach its surface in the next step if its lowest value is at most this multiple of its range.
const REACHABLE_FACTOR: f64 = 20.0;

/// Factor for a step that may hide a sign change: the deviation becomes an eighth.
const HALVING_FACTOR: f64 = 0.5;

/// Error of a function's values inside a step, in units of the tolerance.
const INTERIOR_ERROR_TOLERANCES: f64 = 10.0;

/// Largest change of a function, in roundings, that counts as none.
pub const MAX_CONSTANT_ROUNDINGS: f64 = 8.0;

/// Sample times as fractions of the step.
pub const SAMPLE_FRACTIONS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Limit on the step length from the switching functions.
pub struct Resolution {
    /// Largest magnitude of each function so far.
    sizes: Vec<f64>,
    /// Error of the functions inside a step, as a fraction of their size.
    error: f64,
}

impl Resolution {
    /// Creates the limit for steps with this relative tolerance.
    pub fn new(tolerance: f64) -> Self {
        Self {
            sizes: Vec::new(),
            error: INTERIOR_ERROR_TOLERANCES * tolerance,
        }
    }

    /// Returns the factor by which the next step may grow, or a factor below 1 if this step was too long.
    /// `values` are the functions at [`SAMPLE_FRACTIONS`], `sides` the sides at the start. Changes within `roundings` are
    /// ignored.
    pub fn find_growth_factor(
        &self,
        values: &[Vec<f64>; 5],
        sides: impl Fn(usize) -> f64,
        roundings: &[f64],
    ) -> f64 {
        let mut longest = f64::INFINITY;
        for guard in 0..values[0].len() {
            let side = sides(guard);
            let samples = values.each_ref().map(|values| side * values[guard]);
            let before = self.sizes.get(guard).copied().unwrap_or(0.0);
            let size = find_largest_magnitude(samples, before);
            if side != 0.0 {
                let rounding =
                    MAX_CONSTANT_ROUNDINGS * roundings.get(guard).copied().unwrap_or(0.0);
                longest = longest.min(compute_factor(samples, rounding.max(self.error * size)));
            }
        }
        longest
    }

    /// Updates the sizes of the functions from an accepted step.
    pub fn settle(&mut self, values: &[Vec<f64>; 5]) {
        self.sizes.resize(values[0].len(), 0.0);
        for (guard, size) in self.sizes.iter_mut().enumerate() {
            *size = find_largest_magnitude(values.each_ref().map(|values| values[guard]), *size);
        }
    }
}

/// Returns the largest of `before` and the magnitudes of the samples.
fn find_largest_magnitude(samples: [f64; 5], before: f64) -> f64 {
    let magnitudes = samples.iter().map(|value| value.abs());
    magnitudes.fold(before, f64::max)
}

/// Returns the factor for one function that is positive at the start.
fn compute_factor(samples: [f64; 5], error: f64) -> f64 {
    let lowest = samples.into_iter().fold(f64::INFINITY, f64::min);
    let highest = samples.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let moved = highest - lowest;
    let [a, b, c, d, e] = samples;
    let near = |by: f64, start: f64, end: f64| (0.375 * start + 0.75 * c - 0.125 * end - by).abs();
    let off = near(b, a, e).max(near(d, e, a));
    if off <= error {
        return f64::INFINITY;
    }
    if lowest > REACHABLE_FACTOR * moved {
        // Even a change that grows with the third power of the length would not reach the surface.
        return (lowest / moved).cbrt();
    }
    // The deviation is of third order in the step length.
    let factor = (MAX_DEVIATION_FRACTION * moved / off).cbrt();
    if lowest > HIDDEN_CHANGE_FACTOR * off {
        return factor.max(1.0);
    }
    // A sign change between samples may be hidden. A sign change at a sample is located.
    match lowest >= 0.0 {
        true => factor.min(HALVING_FACTOR),
        false => factor,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(function: impl Fn(f64) -> f64, length: f64) -> f64 {
        let values = SAMPLE_FRACTIONS.map(|part| vec![function(part * length)]);
        Resolution::new(1e-9).find_growth_factor(&values, |_| 1.0, &[])
    }

    #[test]
    fn step_over_many_waves_is_too_long() {
        for length in [4.0, 7.0, 17.0, 29.0, 1000.0] {
            let factor = of(|t| 1.01 + (t + 0.3).sin(), length);
            assert!(factor < 1.0, "{length}: {factor}");
        }
        for length in [0.1, 0.5, 1.0] {
            let factor = of(|t| 1.01 + (t + 0.3).sin(), length);
            assert!((1.0..3.0 / length).contains(&factor), "{length}: {factor}");
        }
    }

    /// The quarter points of several periods may coincide. Steps that grow from short ones do not reach this
    /// length.
    #[test]
    fn growing_steps_stay_within_one_wave() {
        for offset in [1.0001, 1.01, 1.2, 0.9] {
            let mut resolution = Resolution::new(1e-9);
            let (mut t, mut length) = (0.1, 1e-6);
            while t < 1000.0 {
                let values = SAMPLE_FRACTIONS.map(|part| vec![offset + (t + part * length).sin()]);
                let longest = resolution.find_growth_factor(&values, |_| 1.0, &[]);
                if longest >= 1.0 {
                    resolution.settle(&values);
                    t += length;
                }
                length *= longest.clamp(0.2, 8.0);
                assert!(length < 6.2, "{offset} at {t}: {length}");
            }
        }
    }

    /// The switching function of sticking friction is flat between its limits: the parabola fits, but the next
    /// step must not be much longer.
    #[test]
    fn flat_function_limits_growth() {
        let limit = |t: f64| 1.0 - (0.2 + 0.15 * (3.0 * t).sin()).powi(2);
        let factor = of(limit, 0.3);
        assert!((1.0..3.5).contains(&factor), "{factor}");
    }

    #[test]
    fn distant_or_smooth_functions_do_not_limit_steps() {
        assert!(of(|t| 50.0 + t.sin(), 17.0) > 2.0);
        assert_eq!(of(|t| 1.0 - t, 1.0), f64::INFINITY);
        assert_eq!(of(|t| 1e-3 + 2.0 * t - t * t, 1.0), f64::INFINITY);
    }
}
