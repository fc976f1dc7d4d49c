//! Whether a step is short enough to see what switching functions do in it.
//!
//! Where nothing moves the error of a step is zero, however long it is. What a surface bears that holds
//! the motion, or a function of time that switches a force, may go beyond its bound within such a step and
//! come back, and no trial need see it. So a step is held to the switching functions as well: the parabola
//! through a function's values at both ends and in the middle of a step must tell those at its quarters,
//! wherever a change of sign could be hidden in what it does not tell.

/// A parabola tells a function if it is no farther off than this part of how much the function moves.
const TOLD: f64 = 0.1;

/// A change of sign may be hidden where the lowest value is no more than so many times what the parabola is
/// off by.
const HIDDEN: f64 = 2.0;

/// A function comes near its surface in a next step only if it is within so many times its move.
const WITHIN_REACH: f64 = 20.0;

/// In units of the tolerance, what a function's values inside a step may be off by.
const ERRORS: f64 = 10.0;

/// Changes of a function below this number of roundings are no motion.
pub const ROUNDINGS: f64 = 8.0;

/// The parts of a step where functions are asked.
pub const PARTS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// How steps and switching functions go together.
pub struct Resolution {
    /// The largest that each function has been.
    sizes: Vec<f64>,
    /// What is this small beside it is the error of a step.
    error: f64,
}

impl Resolution {
    /// Of steps with this relative tolerance.
    pub fn new(tolerance: f64) -> Self {
        Self {
            sizes: Vec::new(),
            error: ERRORS * tolerance,
        }
    }

    /// The values of the functions at [`PARTS`] of a step, and the sides on which it began: by which factor
    /// a step is longer at most that still sees all, or shorter than 1 where this one did not. Moves within the
    /// `roundings` of the functions, where these are known, are none.
    pub fn longest(
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
            let size = largest(samples, before);
            if side != 0.0 {
                let rounding = ROUNDINGS * roundings.get(guard).copied().unwrap_or(0.0);
                longest = longest.min(factor(samples, rounding.max(self.error * size)));
            }
        }
        longest
    }

    /// Adds the values of a step that stands to the sizes of the functions.
    pub fn settle(&mut self, values: &[Vec<f64>; 5]) {
        self.sizes.resize(values[0].len(), 0.0);
        for (guard, size) in self.sizes.iter_mut().enumerate() {
            *size = largest(values.each_ref().map(|values| values[guard]), *size);
        }
    }
}

/// The largest magnitude of samples and of what was before.
fn largest(samples: [f64; 5], before: f64) -> f64 {
    let magnitudes = samples.iter().map(|value| value.abs());
    magnitudes.fold(before, f64::max)
}

/// The factor for one function, which is positive where the step began.
fn factor(samples: [f64; 5], error: f64) -> f64 {
    let lowest = samples.into_iter().fold(f64::INFINITY, f64::min);
    let highest = samples.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let moved = highest - lowest;
    let [a, b, c, d, e] = samples;
    let near = |by: f64, start: f64, end: f64| (0.375 * start + 0.75 * c - 0.125 * end - by).abs();
    let off = near(b, a, e).max(near(d, e, a));
    let is_within_reach = lowest <= WITHIN_REACH * moved;
    if off <= error || !is_within_reach {
        return f64::INFINITY;
    }
    // What a parabola leaves is of third order.
    let factor = (TOLD * moved / off).cbrt();
    match factor < 1.0 && lowest > HIDDEN * off {
        true => 1.0,
        false => factor,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(function: impl Fn(f64) -> f64, length: f64) -> f64 {
        let values = PARTS.map(|part| vec![function(part * length)]);
        Resolution::new(1e-9).longest(&values, |_| 1.0, &[])
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

    /// Quarter points of many waves may coincide; steps that grow from short ones do not reach
    /// that length.
    #[test]
    fn growing_steps_stay_within_one_wave() {
        for offset in [1.0001, 1.01, 1.2, 0.9] {
            let mut resolution = Resolution::new(1e-9);
            let (mut t, mut length) = (0.1, 1e-6);
            while t < 1000.0 {
                let values = PARTS.map(|part| vec![offset + (t + part * length).sin()]);
                let longest = resolution.longest(&values, |_| 1.0, &[]);
                if longest >= 1.0 {
                    resolution.settle(&values);
                    t += length;
                }
                length *= longest.clamp(0.2, 8.0);
                assert!(length < 6.2, "{offset} at {t}: {length}");
            }
        }
    }

    #[test]
    fn distant_or_smooth_functions_do_not_limit_steps() {
        assert_eq!(of(|t| 50.0 + t.sin(), 17.0), f64::INFINITY);
        assert_eq!(of(|t| 1.0 - t, 1.0), f64::INFINITY);
        assert_eq!(of(|t| 1e-3 + 2.0 * t - t * t, 1.0), f64::INFINITY);
    }
}
