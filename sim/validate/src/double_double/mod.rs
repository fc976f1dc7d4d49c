//! Double-double arithmetic (about 32 digits) for Gauss-Legendre rules, phases of mode shapes and rounding errors of
//! programs.

mod functions;

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Sum `high + low` with `|low|` at most half a unit in the last place of `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    /// Leading part.
    pub high: f64,
    /// Trailing part.
    pub low: f64,
}

impl DoubleDouble {
    /// Returns the number `value`.
    pub const fn new(value: f64) -> Self {
        Self {
            high: value,
            low: 0.0,
        }
    }

    /// Returns the exact product of two `f64`.
    pub fn product(left: f64, right: f64) -> Self {
        let high = left * right;
        Self {
            high,
            low: left.mul_add(right, -high),
        }
    }

    /// Returns the exact sum of two `f64` with `|large| >= |small|` (Dekker).
    fn ordered_sum(large: f64, small: f64) -> Self {
        let high = large + small;
        Self {
            high,
            low: small - (high - large),
        }
    }

    fn sum(left: f64, right: f64) -> Self {
        let high = left + right;
        let shadow = high - left;
        Self {
            high,
            low: (left - (high - shadow)) + (right - shadow),
        }
    }

    /// Returns the quotient to double-double accuracy, by one correction of the `f64` quotient.
    pub fn quotient(self, divisor: Self) -> Self {
        let first = self.high / divisor.high;
        let rest = self - divisor * Self::new(first);
        Self::ordered_sum(first, (rest.high + rest.low) / divisor.high)
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let sum = Self::sum(self.high, other.high);
        Self::ordered_sum(sum.high, sum.low + (self.low + other.low))
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = Self::product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        Self::ordered_sum(product.high, product.low + cross)
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        self.quotient(other)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl AddAssign for DoubleDouble {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_third_times_three_is_one_to_thirty_digits() {
        let third = DoubleDouble::new(1.0).quotient(DoubleDouble::new(3.0));
        let rest = third * DoubleDouble::new(3.0) - DoubleDouble::new(1.0);
        assert!(third.low != 0.0);
        assert!((rest.high + rest.low).abs() < 1e-31, "{rest:?}");
    }

    #[test]
    fn sum_keeps_digits_beyond_f64() {
        let sum = DoubleDouble::new(1.0) + DoubleDouble::new(1e-25);
        let rest = sum - DoubleDouble::new(1.0);
        assert_eq!(rest.high, 1e-25);
    }
}
