//! Double-double numbers: unevaluated sums of two doubles with 106 bits. This module contains the arithmetic; sine,
//! cosine and exponential are in [`elementary`](super::elementary).
//!
//! Sources: Dekker, "A floating-point technique for extending the available precision", Numer. Math. 18 (1971); Hida,
//! Li, Bailey, "Library for double-double and quad-double arithmetic" (2000), from which the accurate addition is
//! taken.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Sum `high + low` with |low| at most half a unit in the last place of `high`. Therefore comparing the pairs
/// lexicographically compares the numbers.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct DoubleDouble {
    /// Double nearest to the number.
    pub high: f64,
    /// Remainder.
    pub low: f64,
}

impl DoubleDouble {
    /// Returns the number with exactly this value.
    pub const fn exactly(value: f64) -> Self {
        Self {
            high: value,
            low: 0.0,
        }
    }

    /// Returns the product with a double.
    pub fn times(self, factor: f64) -> Self {
        let (product, error) = exact_product(self.high, factor);
        ordered_sum(product, error + self.low * factor)
    }
}

/// Returns a + b and its rounding error, exactly (Knuth).
fn exact_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let share = sum - a;
    (sum, (a - (sum - share)) + (b - share))
}

/// Returns the normalised a + b, if |a| >= |b| (Dekker).
fn ordered_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble {
        high,
        low: b - (high - a),
    }
}

/// Splits `a` into two halves of 26 bits, whose products are exact (Veltkamp). It overflows above 2^996, far above all
/// quantities of the arm.
fn halves(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let scaled = SPLITTER * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}

/// Returns a b and its rounding error, exactly (Dekker). It uses plain operations, because a fused multiply-add is a
/// slow library call on processors without this instruction.
fn exact_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let (a_high, a_low) = halves(a);
    let (b_high, b_low) = halves(b);
    let error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (product, error)
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (high, error) = exact_sum(self.high, other.high);
        let (low, lost) = exact_sum(self.low, other.low);
        let sum = ordered_sum(high, error + low);
        ordered_sum(sum.high, sum.low + lost)
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

impl Sub for DoubleDouble {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (product, error) = exact_product(self.high, other.high);
        let crossed = self.high * other.low + self.low * other.high;
        ordered_sum(product, error + crossed)
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    /// Long division with doubles as digits.
    fn div(self, divisor: Self) -> Self {
        let first = self.high / divisor.high;
        let rest = self - divisor.times(first);
        let second = rest.high / divisor.high;
        let rest = rest - divisor.times(second);
        let third = rest.high / divisor.high;
        ordered_sum(first, second) + Self::exactly(third)
    }
}
