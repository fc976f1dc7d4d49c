//! Double-doubles: the unevaluated sum of two doubles, 106 bits. Arithmetic only; sine,
//! cosine and exponential are in [`elementary`](super::elementary).
//!
//! Sources: Dekker, "A floating-point technique for extending the available precision",
//! Numer. Math. 18 (1971); Hida, Li, Bailey, "Library for double-double and quad-double
//! arithmetic" (2000), whose accurate addition this is.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// `high + low` with |low| at most half a unit in the last place of `high`, so that the
/// order of two numbers is the order of their pairs.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct DoubleDouble {
    /// The nearest double.
    pub high: f64,
    /// What it lacks.
    pub low: f64,
}

impl DoubleDouble {
    /// The number with exactly this value.
    pub const fn exactly(value: f64) -> Self {
        Self {
            high: value,
            low: 0.0,
        }
    }

    /// The product with a double.
    pub fn times(self, factor: f64) -> Self {
        let (product, error) = exact_product(self.high, factor);
        ordered_sum(product, error + self.low * factor)
    }
}

/// a + b and its rounding error, exactly (Knuth).
fn exact_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let share = sum - a;
    (sum, (a - (sum - share)) + (b - share))
}

/// The normalised a + b, for |a| at least |b| (Dekker).
fn ordered_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble {
        high,
        low: b - (high - a),
    }
}

/// `a` in two halves of 26 bits, whose products are exact (Veltkamp). Overflows beyond
/// 2^996, which no quantity of the arm approaches.
fn halves(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let scaled = SPLITTER * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}

/// a b and its rounding error, exactly (Dekker). Plain operations, because a fused one is
/// a call into the library on processors that may lack it.
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
