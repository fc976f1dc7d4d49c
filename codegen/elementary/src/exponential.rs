//! Exponential functions: `exp`, `exp_minus_one`, `sinh`, `cosh`, `tanh`.
//!
//! The argument is reduced to `x = k ln 2 + r`, `|r| <= ln(2)/2`, with the remainder r as a pair. A polynomial
//! approximates `e^r`. The result is scaled by `2^k`, in two steps if it can be subnormal. The hyperbolic functions
//! use a quarter of `e^x - 1`, so that no intermediate value overflows before the result does.

use crate::approximation::{clamp, nearest_integer, polynomial, scale_by_power_of_two};
use crate::pair::{Pair, exact_sum, ordered_sum, quotient};
use crate::precision::Precision;
use crate::real::{Format, Real};

/// Computes `e^x`.
///
/// Largest error measured: 0.76 ulp.
#[inline]
pub fn exp<R: Real>(x: R) -> R {
    let (lowest, highest) = Format::<R>::EXPONENTIAL_RANGE;
    exponential_of_pair(Pair {
        high: clamp(x, lowest, highest),
        low: R::constant(0.0),
    })
}

/// Computes `e^(high + low)` for `high` in the range of the exponential and `|low|` at most one unit in the last
/// place of `high`.
#[inline(always)]
pub(crate) fn exponential_of_pair<R: Real>(x: Pair<R>) -> R {
    let (k, r, rest) = reduce(x);
    let value = ordered_sum(R::constant(1.0), r).add_to_low(rest).round();
    scale_by_power_of_two(value, k)
}

/// Computes `e^x - 1`, accurate also for small `x`.
///
/// Largest error measured: 1.10 ulp.
#[inline]
pub fn exp_minus_one<R: Real>(x: R) -> R {
    let (_, highest) = Format::<R>::EXPONENTIAL_RANGE;
    let value = quarter_exp_minus_one(clamp(x, Format::<R>::FLAT_EXPONENTIAL, highest)).round();
    let value = value * R::constant(4.0);
    // For arguments below `tiny` the function equals its argument, signed zero and subnormals included.
    let tiny = R::constant(Format::<R>::EPSILON / 4.0);
    R::select_less(x.abs(), tiny, x, value)
}

/// Computes the hyperbolic sine.
///
/// Largest error measured: 1.15 ulp.
#[inline]
pub fn sinh<R: Real>(x: R) -> R {
    let one = R::constant(1.0);
    // With w = (e^|x| - 1)/4: sinh|x| = 2 (w + w/(1 + 4 w)).
    let w = quarter_exp_minus_one(clamp(x.abs(), 0.0, Format::<R>::LARGEST_HYPERBOLIC)).normalise();
    let four = R::constant(4.0);
    let growth = w.high * four;
    let denominator = exact_sum(one, growth);
    let inverse = one / denominator.high;
    let decaying = w.high / denominator.high;
    let relative_rest = (denominator.low + w.low * four) * inverse;
    let rest = w.low + (w.low * inverse - decaying * relative_rest);
    // An infinite denominator would make `rest` NaN. The decaying exponential is negligible for such arguments.
    let rest = R::select_less(growth, R::constant(Format::<R>::HUGE), rest, w.low);
    let sum = ordered_sum(w.high, decaying).add_to_low(rest);
    let magnitude = sum.round() * R::constant(2.0);
    extend_odd_function(x, magnitude)
}

/// Computes the hyperbolic cosine.
///
/// Largest error measured: 0.88 ulp.
#[inline]
pub fn cosh<R: Real>(x: R) -> R {
    let (k, r, rest) = reduce(Pair {
        high: clamp(x.abs(), 0.0, Format::<R>::LARGEST_HYPERBOLIC),
        low: R::constant(0.0),
    });
    // With w = e^|x|/4: cosh x = 2 (w + 1/(16 w)).
    let w = ordered_sum(R::constant(1.0), r)
        .add_to_low(rest)
        .normalise();
    let quarter = (k - R::constant(2.0)).power_of_two();
    let (high, low) = (w.high * quarter, w.low * quarter);
    let decaying = R::constant(0.0625) / high;
    (high + (low + decaying)) * R::constant(2.0)
}

/// Computes the hyperbolic tangent.
///
/// Largest error measured: 0.91 ulp.
#[inline]
pub fn tanh<R: Real>(x: R) -> R {
    // With w = (e^(2|x|) - 1)/4: tanh|x| = w/(w + 1/2).
    let doubled = clamp(x.abs(), 0.0, Format::<R>::FLAT_TANGENT) * R::constant(2.0);
    let w = quarter_exp_minus_one(doubled).normalise();
    let denominator = exact_sum(w.high, R::constant(0.5)).add_to_low(w.low);
    extend_odd_function(x, quotient(w, denominator).round())
}

/// Extends an odd function from its values for positive arguments. Returns `x` itself if its error is a small
/// fraction of a unit in the last place, signed zero and subnormals included.
#[inline(always)]
fn extend_odd_function<R: Real>(x: R, magnitude: R) -> R {
    let tiny = R::constant(Format::<R>::TINY);
    R::select_less(x.abs(), tiny, x, magnitude.copysign(x))
}

/// Computes `(e^x - 1)/4` as a pair that is not normalised, for `x` from `FLAT_EXPONENTIAL` up to the largest
/// argument.
#[inline(always)]
fn quarter_exp_minus_one<R: Real>(x: R) -> Pair<R> {
    let (k, r, rest) = reduce(Pair {
        high: x,
        low: R::constant(0.0),
    });
    let quarter = (k - R::constant(2.0)).power_of_two();
    let offset = exact_sum(quarter, R::constant(-0.25));
    // `|offset|` is larger than `|r| quarter` unless k = 0, in which case `offset` is zero.
    ordered_sum(offset.high, r * quarter).add_to_low(offset.low + rest * quarter)
}

/// Returns `k`, `r` and a small remainder with `e^(x.high + x.low) = 2^k (1 + r + remainder)`.
#[inline(always)]
fn reduce<R: Real>(x: Pair<R>) -> (R, R, R) {
    let k = nearest_integer(x.high * R::constant(core::f64::consts::LOG2_E));
    let leading = x.high - k * R::constant(Format::<R>::LN_2.high);
    let r = ordered_sum(leading, x.low - k * R::constant(Format::<R>::LN_2.low));
    let curved = (r.high * r.high) * polynomial(r.high, Format::<R>::EXPONENTIAL);
    (k, r.high, curved + r.low)
}
