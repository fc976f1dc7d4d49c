//! Time as a sum of two floating-point numbers, so that a million switches do not add up
//! their roundings, and phases that are as accurate as the time.

use nalgebra::Complex;

use super::error_free::{two_product, two_sum};

/// A time, s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Clock {
    time: f64,
    rest: f64,
}

impl Clock {
    /// This time exactly.
    pub fn new(time: f64) -> Self {
        Self { time, rest: 0.0 }
    }

    /// Later by `step` s.
    pub fn advanced_by(self, step: f64) -> Self {
        let (sum, error) = two_sum(self.time, step);
        let (time, rest) = two_sum(sum, error + self.rest);
        Self { time, rest }
    }

    /// The nearest floating-point number, s.
    pub fn time(self) -> f64 {
        self.time
    }

    /// Returns the time until `later`, s.
    pub fn time_until(self, later: f64) -> f64 {
        (later - self.time) - self.rest
    }

    /// exp(i (rate t + offset)).
    pub fn phase(self, [rate, offset]: [f64; 2]) -> Complex<f64> {
        let (angle, error) = two_product(rate, self.time);
        let rest = error + rate * self.rest;
        let (angle, more) = two_sum(angle, offset);
        let (sine, cosine) = angle.sin_cos();
        Complex::new(cosine, sine) * Complex::new(1.0, rest + more)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn million_steps_do_not_drift() {
        let mut clock = Clock::new(0.0);
        for _ in 0..1_000_000 {
            clock = clock.advanced_by(0.1);
        }
        // 0.1 as a floating-point number, a million times.
        let wanted = 100_000.0 + 1e6 * (0.1 - 0.1);
        assert!(clock.time_until(wanted).abs() < 1e-11, "{clock:?}");
        // The number 0.1 is too large by 5.55e-18.
        assert!((clock.time_until(wanted) + 5.551_115e-12).abs() < 1e-16);
    }

    #[test]
    fn phases_are_as_accurate_as_time() {
        let rate = 10.0 * std::f64::consts::PI;
        let clock = Clock::new(12_345.678);
        let (product, error) = two_product(rate, 12_345.678);
        let turn = 2.0 * std::f64::consts::PI;
        // Same angle, reduced before the rounding error is added.
        let angle = product.rem_euclid(turn);
        let wanted = Complex::new((angle + error).cos(), (angle + error).sin());
        // The rounding of 2 pi counts 6e4 times.
        assert!((clock.phase([rate, 0.0]) - wanted).norm() < 6.2e4 * 2.5e-16);
    }
}
