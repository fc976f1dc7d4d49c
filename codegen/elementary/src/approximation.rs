//! Building blocks of the functions: polynomials, rounding to an integer, clamping, and the split into
//! significand and exponent.
//!
//! The coefficients of each polynomial minimise the largest relative error of the *function* over the stated
//! interval (computed in 50 digits, then rounded to doubles one after the other, with a new fit of the others
//! each time).

use crate::real::Real;

/// Computes the polynomial `sum of coefficients[i] x^i` in Estrin's order: neighbours are combined with `x`,
/// the results with `x^2`, then `x^4` and so on. The order of summation is fixed and the dependency chain
/// short.
#[inline(always)]
pub(crate) fn polynomial<R: Real, const N: usize>(x: R, coefficients: &[f64; N]) -> R {
    const { assert!(N > 0, "a polynomial has a constant term") };
    let mut terms = coefficients.map(R::constant);
    let mut length = N;
    let mut power = x;
    while length > 1 {
        let joined = length / 2;
        for i in 0..joined {
            terms[i] = terms[2 * i] + power * terms[2 * i + 1];
        }
        if length % 2 == 1 {
            terms[joined] = terms[length - 1];
        }
        length -= joined;
        power = power * power;
    }
    terms[0]
}

/// Constant `3 * 2^51`: within 2^51 of it, the doubles are the integers. Kernels round by adding and
/// subtracting it.
pub const ROUNDING_ALIGNER: f64 = (3_u64 << 51) as f64;

/// Returns the integer nearest to `x`, ties to even, for `|x| <= 2^51`; `+0` for zero.
#[inline(always)]
pub(crate) fn nearest_integer<R: Real>(x: R) -> R {
    let aligner = R::constant(ROUNDING_ALIGNER);
    (x + aligner) - aligner
}

/// Limits `x` to `[lowest, highest]`; NaN stays NaN.
#[inline(always)]
pub(crate) fn clamp<R: Real>(x: R, lowest: f64, highest: f64) -> R {
    let (lowest, highest) = (R::constant(lowest), R::constant(highest));
    let below = R::select_less(highest, x, highest, x);
    R::select_less(x, lowest, lowest, below)
}

/// Returns `value 2^k` for integral `|k| <= 1100`, rounded once if `value` is near one, also to zero, a
/// subnormal or infinity.
#[inline(always)]
pub(crate) fn scale_by_power_of_two<R: Real>(value: R, k: R) -> R {
    let first = nearest_integer(k * R::constant(0.5));
    (value * first.power_of_two()) * (k - first).power_of_two()
}

/// Factor that makes any subnormal normal.
const TWO_TO_54: f64 = (1_u64 << 54) as f64;

/// Returns significand in `[1, 2)` and integral exponent of a positive finite `x = significand 2^exponent`,
/// subnormals included; meaningless finite values for any other `x`.
#[inline(always)]
pub(crate) fn split_exponent<R: Real>(x: R) -> (R, R) {
    let smallest_normal = R::constant(f64::MIN_POSITIVE);
    let raised = x * R::constant(TWO_TO_54);
    let normal = R::select_less(x, smallest_normal, raised, x);
    let shift = R::select_less(x, smallest_normal, R::constant(54.0), R::constant(0.0));
    (normal.significand(), normal.exponent() - shift)
}
