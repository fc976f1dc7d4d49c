//! Piecewise functions of models and reciprocals of pivots, computed by arithmetic and selections only.
//!
//! A comparison with NaN is false: contact and above are 0 for NaN, the dead zone is NaN for a deflection of NaN
//! and has no edge for a width of NaN.

use crate::real::Real;

/// Returns the deflection beyond a play of half-width b: `p - b` above it, `p + b` below it, or 0 within it.
#[inline]
pub fn deadzone<R: Real>(p: R, b: R) -> R {
    let held = R::select_less(b, p, b, p);
    p - R::select_less(held, -b, -b, held)
}

/// Returns 1 if `|p| > b`, else 0. The magnitude is compared once, because gcc would compile two comparisons to a
/// branch.
#[inline]
pub fn contact<R: Real>(p: R, b: R) -> R {
    let size = R::select_less(p, -p, -p, p);
    R::select_less(b, size, R::constant(1.0), R::constant(0.0))
}

/// Returns 1 if `p > 0`, else 0.
#[inline]
pub fn above<R: Real>(p: R) -> R {
    let zero = R::constant(0.0);
    R::select_less(zero, p, R::constant(1.0), zero)
}

/// Returns `1/pivot` if `pivot > 0`, else NaN.
#[inline]
pub fn pivot_reciprocal<R: Real>(pivot: R) -> R {
    let reciprocal = R::constant(1.0) / pivot;
    R::select_less(R::constant(0.0), pivot, reciprocal, R::constant(f64::NAN))
}
