//! Numbers represented as the unevaluated sum of two numbers, with error-free operations.
//!
//! The operations keep the rounding errors of intermediate results of the elementary functions; they are not a
//! complete double-double arithmetic. Without fused multiply-add, the factors of a product are split in halves
//! (Dekker 1971).

use crate::precision::Precision;
use crate::real::{Format, Real};

/// The value `high + low`; `low` is a small correction to `high`.
#[derive(Clone, Copy, Debug)]
pub struct Pair<R> {
    /// Leading part.
    pub high: R,
    /// Rounding error of `high`.
    pub low: R,
}

impl<R: Real> Pair<R> {
    /// Rounds the pair to one number.
    #[inline(always)]
    pub fn round(self) -> R {
        self.high + self.low
    }

    /// Makes the leading part the rounded value of the sum again. The low part may have grown, but not beyond the
    /// leading part.
    #[inline(always)]
    pub fn normalise(self) -> Self {
        ordered_sum(self.high, self.low)
    }

    /// Adds a small correction to the low part.
    #[inline(always)]
    pub fn add_to_low(self, correction: R) -> Self {
        Pair {
            high: self.high,
            low: self.low + correction,
        }
    }
}

/// Returns `a + b` and its rounding error. The error is exact if `a` is zero or a multiple of the last place of `b`,
/// in particular if `|a| >= |b|`.
#[inline(always)]
pub(crate) fn ordered_sum<R: Real>(a: R, b: R) -> Pair<R> {
    let high = a + b;
    Pair {
        high,
        low: (a - high) + b,
    }
}

/// Returns `a + b` and its rounding error, exact for any order of magnitudes (Knuth).
#[inline(always)]
pub(crate) fn exact_sum<R: Real>(a: R, b: R) -> Pair<R> {
    let high = a + b;
    let b_seen = high - a;
    let a_seen = high - b_seen;
    Pair {
        high,
        low: (a - a_seen) + (b - b_seen),
    }
}

/// Splits `a` into halves of at most 26 bits each (12 in single precision; Veltkamp), without overflow for
/// `|a| < 2^996` (2^115).
#[inline(always)]
fn split_halves<R: Real>(a: R) -> Pair<R> {
    let scaled = a * R::constant(Format::<R>::SPLITTER);
    let high = scaled - (scaled - a);
    Pair {
        high,
        low: a - high,
    }
}

/// Returns `a b` and its rounding error, exact without overflow and underflow.
#[inline(always)]
pub(crate) fn exact_product<R: Real>(a: R, b: R) -> Pair<R> {
    let (x, y) = (split_halves(a), split_halves(b));
    let high = a * b;
    let rest = ((x.high * y.high - high) + x.high * y.low) + x.low * y.high;
    Pair {
        high,
        low: rest + x.low * y.low,
    }
}

/// Returns `a^2` and its rounding error, exact without overflow and underflow.
#[inline(always)]
pub(crate) fn exact_square<R: Real>(a: R) -> Pair<R> {
    let x = split_halves(a);
    let high = a * a;
    let cross = x.high * x.low;
    Pair {
        high,
        low: ((x.high * x.high - high) + (cross + cross)) + x.low * x.low,
    }
}

/// Computes `numerator / denominator` to about 100 bits: the leading parts are divided by means of a reciprocal, then
/// one correction step uses the exact remainder.
///
/// The correction is subtracted, so that a zero or tiny numerator keeps its sign.
#[inline(always)]
pub(crate) fn quotient<R: Real>(numerator: Pair<R>, denominator: Pair<R>) -> Pair<R> {
    let reciprocal = R::constant(1.0) / denominator.high;
    let high = numerator.high * reciprocal;
    let product = exact_product(high, denominator.high);
    let excess = (product.high - numerator.high) + product.low;
    let excess = excess + (high * denominator.low - numerator.low);
    Pair {
        high,
        low: -(excess * reciprocal),
    }
}
