//! Magnitude, sign, minimum and maximum: one or two selections each, with NaN defined.

use crate::real::Real;

/// The magnitude; NaN for NaN.
#[inline]
pub fn abs<R: Real>(x: R) -> R {
    x.abs()
}

/// 1, -1, or the argument itself where it is a zero or NaN: `sign(0) = 0`.
#[inline]
pub fn sign<R: Real>(x: R) -> R {
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    let not_positive = R::select_less(x, zero, R::constant(-1.0), x);
    R::select_less(zero, x, one, not_positive)
}

/// The smaller argument, `a` if they are equal, NaN if either is.
#[inline]
pub fn min<R: Real>(a: R, b: R) -> R {
    R::select_equal(b, b, R::select_less(b, a, b, a), b)
}

/// The larger argument, `a` if they are equal, NaN if either is.
#[inline]
pub fn max<R: Real>(a: R, b: R) -> R {
    R::select_equal(b, b, R::select_less(a, b, b, a), b)
}
