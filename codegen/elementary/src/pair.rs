//! Numbers held as an unevaluated sum of two doubles, and the error-free operations that make them.
//!
//! Only what the elementary functions need to carry a rounding error along; not a double-double
//! arithmetic. There is no fused multiply-add: products are split in halves (Dekker 1971).

use crate::real::Real;

/// The value `high + low`, with `low` a correction to `high`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<R> {
    /// The leading part.
    pub high: R,
    /// What `high` misses.
    pub low: R,
}

impl<R: Real> Pair<R> {
    /// The pair rounded to one double.
    #[inline(always)]
    pub fn round(self) -> R {
        self.high + self.low
    }

    /// The same value with the leading part rounded from it all, for a low part that has grown
    /// (but not beyond the leading part).
    #[inline(always)]
    pub fn normalised(self) -> Self {
        ordered_sum(self.high, self.low)
    }

    /// The pair plus a small correction to its low part.
    #[inline(always)]
    pub fn plus_low(self, correction: R) -> Self {
        Pair {
            high: self.high,
            low: self.low + correction,
        }
    }
}

/// `a + b` and its rounding error, exact if `a` is zero or a multiple of the last place of `b`
/// (in particular if `|a| >= |b|`).
#[inline(always)]
pub(crate) fn ordered_sum<R: Real>(a: R, b: R) -> Pair<R> {
    let high = a + b;
    Pair {
        high,
        low: (a - high) + b,
    }
}

/// `a + b` and its rounding error, exact whatever their order (Knuth).
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

/// `2^27 + 1`.
const SPLITTER: f64 = ((1_u64 << 27) + 1) as f64;

/// Splits `a` into halves of at most 26 bits each (Veltkamp); `|a| < 2^996`.
#[inline(always)]
fn halves<R: Real>(a: R) -> Pair<R> {
    let scaled = a * R::constant(SPLITTER);
    let high = scaled - (scaled - a);
    Pair {
        high,
        low: a - high,
    }
}

/// `a b` and its rounding error, exact while nothing overflows or underflows.
#[inline(always)]
pub(crate) fn exact_product<R: Real>(a: R, b: R) -> Pair<R> {
    let (x, y) = (halves(a), halves(b));
    let high = a * b;
    let rest = ((x.high * y.high - high) + x.high * y.low) + x.low * y.high;
    Pair {
        high,
        low: rest + x.low * y.low,
    }
}

/// `a^2` and its rounding error, exact while nothing overflows or underflows.
#[inline(always)]
pub(crate) fn exact_square<R: Real>(a: R) -> Pair<R> {
    let x = halves(a);
    let high = a * a;
    let cross = x.high * x.low;
    Pair {
        high,
        low: ((x.high * x.high - high) + (cross + cross)) + x.low * x.low,
    }
}

/// `numerator / denominator` to about 100 bits: the quotient of the leading parts by reciprocal,
/// then one step with the exact remainder.
///
/// A zero or tiny numerator keeps its sign: the correction is subtracted.
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
