//! Time as a sum of two floating-point numbers, so that rounding errors of a million switches do not
//! accumulate, and phases with the accuracy of this time.

use nalgebra::Complex;

use super::error_free::{two_product, two_sum};

/// A time, s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Clock {
    time: f64,
    rest: f64,
}

impl Clock {
    /// Creates the exact sum for a floating-point time, s.
    pub fn new(time: f64) -> Self {
        Self { time, rest: 0.0 }
    }

    /// Returns the time `step` s later.
    pub fn advanced_by(self, step: f64) -> Self {
        let (sum, error) = two_sum(self.time, step);
        let (time, rest) = two_sum(sum, error + self.rest);
        Self { time, rest }
    }

    /// Returns the nearest floating-point number, s.
    pub fn time(self) -> f64 {
        self.time
    }

    /// Returns the duration until `later`, s.
    pub fn time_until(self, later: f64) -> f64 {
        (later - self.time) - self.rest
    }

    /// Returns exp(i (rate t + offset)).
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
        // The floating-point number 0.1, added a million times.
        let wanted = 100_000.0 + 1e6 * (0.1 - 0.1);
        assert!(clock.time_until(wanted).abs() < 1e-11, "{clock:?}");
        // The floating-point number nearest to 0.1 is too large by 5.55e-18.
        assert!((clock.time_until(wanted) + 5.551_115e-12).abs() < 1e-16);
    }

    #[test]
    fn phases_are_as_accurate_as_time() {
        let rate = 10.0 * std::f64::consts::PI;
        let clock = Clock::new(12_345.678);
        let (product, error) = two_product(rate, 12_345.678);
        let turn = 2.0 * std::f64::consts::PI;
        // The same angle, reduced to one turn before the rounding error is added.
        let angle = product.rem_euclid(turn);
        let wanted = Complex::new((angle + error).cos(), (angle + error).sin());
        // The rounding error of 2 pi is multiplied by 6e4.
        assert!((clock.phase([rate, 0.0]) - wanted).norm() < 6.2e4 * 2.5e-16);
    }
}
