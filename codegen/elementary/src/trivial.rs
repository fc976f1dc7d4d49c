//! Magnitude, sign, minimum and maximum: one or two selections each, with defined results for NaN.

use crate::real::Real;

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

/// Returns the smaller argument, `a` if they are equal, NaN if either is.
#[inline]
pub fn min<R: Real>(a: R, b: R) -> R {
    R::select_equal(b, b, R::select_less(b, a, b, a), b)
}

/// Returns the larger argument, `a` if they are equal, NaN if either is.
#[inline]
pub fn max<R: Real>(a: R, b: R) -> R {
    R::select_equal(b, b, R::select_less(a, b, b, a), b)
}
