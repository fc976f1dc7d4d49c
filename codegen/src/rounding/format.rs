//! Rounding in the two number formats.

use eomgen_model_spec::interval::Interval;

/// Number format of a computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// IEEE 754 double precision.
    Double,
    /// IEEE 754 single precision.
    Single,
}

impl Format {
    /// Both formats.
    pub const ALL: [Self; 2] = [Self::Double, Self::Single];

    /// Returns the name of the type in emitted Rust.
    pub fn name(self) -> &'static str {
        match self {
            Self::Double => "f64",
            Self::Single => "f32",
        }
    }

    /// Returns the nearest number of the format.
    pub fn round(self, number: f64) -> f64 {
        match self {
            Self::Double => number,
            Self::Single => f64::from(number as f32),
        }
    }

    /// Returns the largest finite number.
    pub(super) fn largest(self) -> f64 {
        match self {
            Self::Double => f64::MAX,
            Self::Single => f64::from(f32::MAX),
        }
    }

    /// Returns the smallest positive normal number.
    pub(super) fn smallest_normal(self) -> f64 {
        match self {
            Self::Double => f64::MIN_POSITIVE,
            Self::Single => f64::from(f32::MIN_POSITIVE),
        }
    }

    /// Returns the unit roundoff: half the distance between 1 and the next larger number.
    fn unit(self) -> f64 {
        match self {
            Self::Double => f64::EPSILON / 2.0,
            Self::Single => f64::from(f32::EPSILON) / 2.0,
        }
    }

    /// Returns half the smallest positive number; in double precision the smallest positive number, because its half
    /// underflows.
    pub(super) fn smallest_half(self) -> f64 {
        match self {
            Self::Double => f64::from_bits(1),
            Self::Single => f64::from(f32::from_bits(1)) / 2.0,
        }
    }

    /// Returns half a unit in the last place of numbers up to `magnitude`.
    pub(super) fn half_unit_in_last_place(self, magnitude: f64) -> f64 {
        match magnitude < self.smallest_normal() {
            true => self.smallest_half(),
            // The largest power of two that is at most the magnitude.
            false => f64::from_bits(magnitude.to_bits() & !((1 << 52) - 1)) * self.unit(),
        }
    }

    /// Returns a bound of the rounding error of a number in `exact`.
    pub(super) fn rounding(self, exact: Interval) -> f64 {
        let (low, high) = (self.round(exact.low), self.round(exact.high));
        let magnitude = exact.low.abs().max(exact.high.abs());
        let general = match magnitude == 0.0 {
            true => 0.0,
            false => self.half_unit_in_last_place(magnitude),
        };
        // All numbers of the interval have the same rounded value.
        let common = (low - exact.low).abs().max((high - exact.high).abs());
        match low == high {
            true => general.min(above(common)),
            false => general,
        }
    }
}

/// Returns a number that is at least the exact result of a few operations on positive numbers.
pub(super) fn above(number: f64) -> f64 {
    const ROUNDING: f64 = 4e-15;
    match number == 0.0 {
        true => 0.0,
        false => number * (1.0 + ROUNDING) + f64::from_bits(1),
    }
}
