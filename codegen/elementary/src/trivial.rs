//! Magnitude, sign, minimum, maximum and quantisation: a few selections each, with defined results for NaN.

use crate::approximation::nearest_integer;
use crate::precision::Precision;
use crate::real::{Format, Real};

/// Returns the magnitude; NaN for NaN.
#[inline]
pub fn abs<R: Real>(x: R) -> R {
    x.abs()
}

/// Returns 1, -1, or the argument itself if it is a zero or NaN: `sign(0) = 0`.
#[inline]
pub fn sign<R: Real>(x: R) -> R {
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    let not_positive = R::select_less(x, zero, R::constant(-1.0), x);
    R::select_less(zero, x, one, not_positive)
}

/// Returns the smaller argument, `a` if both are equal, NaN if either is NaN.
#[inline]
pub fn min<R: Real>(a: R, b: R) -> R {
    R::select_equal(b, b, R::select_less(b, a, b, a), b)
}

/// Returns the larger argument, `a` if both are equal, NaN if either is NaN.
#[inline]
pub fn max<R: Real>(a: R, b: R) -> R {
    R::select_equal(b, b, R::select_less(a, b, b, a), b)
}

/// Returns the multiple of `step` that is nearest to x; halves are rounded away from zero. The quotient `x/step` is
/// at most `2^51` (2^22 in single precision). Returns NaN if `step` is 0.
#[inline]
pub fn quantise<R: Real>(x: R, step: R) -> R {
    let ratio = x / step;
    let size = ratio.abs();
    let even = nearest_integer(size);
    let next = even + R::constant(1.0);
    let nearest = R::select_equal(size - even, R::constant(0.5), next, even);
    // Larger quotients are not rounded.
    let largest = R::constant(0.5 * Format::<R>::ALL_INTEGERS);
    let count = R::select_less(size, largest, nearest, size);
    step * count.copysign(ratio)
}
