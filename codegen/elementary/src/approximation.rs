//! Small building blocks shared by the functions: polynomials, rounding to an integer, clamping,
//! and taking a number apart into significand and exponent.
//!
//! The polynomials' coefficients stand next to the functions that use them. All of them minimise
//! the largest relative error of the *function* over the stated interval (computed in 50 digits,
//! then rounded to doubles one coefficient after the other, refitting the rest each time).

use crate::real::Real;

/// The polynomial `sum of coefficients[i] x^i`, in Estrin's order: neighbours are joined with `x`,
/// the results with `x^2`, then `x^4`, ...: the order of summation is fixed and the chain short.
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

/// `3 * 2^51`: in its binade, up and down by 2^51, doubles are the integers. Kernels round by
/// adding and subtracting it.
pub const ROUNDING_ALIGNER: f64 = (3_u64 << 51) as f64;

/// The integer nearest to `x`, ties to even, for `|x| <= 2^51`; `+0` for zero.
#[inline(always)]
pub(crate) fn nearest_integer<R: Real>(x: R) -> R {
    let aligner = R::constant(ROUNDING_ALIGNER);
    (x + aligner) - aligner
}

/// `x` limited to `[lowest, highest]`; NaN stays NaN.
#[inline(always)]
pub(crate) fn clamp<R: Real>(x: R, lowest: f64, highest: f64) -> R {
    let (lowest, highest) = (R::constant(lowest), R::constant(highest));
    let below = R::select_less(highest, x, highest, x);
    R::select_less(x, lowest, lowest, below)
}

/// `value 2^k` for integral `|k| <= 1100`, rounded once (to zero, a subnormal or infinity where the
/// result lies there) if `value` is near one.
#[inline(always)]
pub(crate) fn scale_by_power_of_two<R: Real>(value: R, k: R) -> R {
    let first = nearest_integer(k * R::constant(0.5));
    (value * first.power_of_two()) * (k - first).power_of_two()
}

/// Enough to make any subnormal normal.
const TWO_TO_54: f64 = (1_u64 << 54) as f64;

/// `x = significand 2^exponent` of a positive finite `x`, subnormals included; significand in
/// `[1, 2)`, exponent integral. Finite values of no meaning for any other `x`.
#[inline(always)]
pub(crate) fn take_apart<R: Real>(x: R) -> (R, R) {
    let smallest_normal = R::constant(f64::MIN_POSITIVE);
    let raised = x * R::constant(TWO_TO_54);
    let normal = R::select_less(x, smallest_normal, raised, x);
    let shift = R::select_less(x, smallest_normal, R::constant(54.0), R::constant(0.0));
    (normal.significand(), normal.exponent() - shift)
}
