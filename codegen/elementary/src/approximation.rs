//! Building blocks of the functions: polynomials, rounding to an integer, clamping, and the split into
//! significand and exponent.

use crate::precision::Precision;
use crate::real::{Format, Real};

/// Largest number of coefficients.
const LARGEST_LENGTH: usize = 13;

/// Computes the polynomial `sum of coefficients[i] x^i` in Estrin's order: neighbours are combined with `x`,
/// the results with `x^2`, then `x^4` and so on. The order of summation is fixed and the dependency chain
/// short.
#[inline(always)]
pub(crate) fn polynomial<R: Real>(x: R, coefficients: &[f64]) -> R {
    let mut terms = [R::constant(0.0); LARGEST_LENGTH];
    for (term, coefficient) in terms.iter_mut().zip(coefficients) {
        *term = R::constant(*coefficient);
    }
    let mut length = coefficients.len().min(LARGEST_LENGTH);
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

/// Computes the polynomial in Horner's order, which has the fewest operations.
#[inline(always)]
pub(crate) fn short_polynomial<R: Real>(x: R, coefficients: &[f64]) -> R {
    match coefficients {
        [] => R::constant(0.0),
        [last] => R::constant(*last),
        [first, rest @ ..] => R::constant(*first) + x * short_polynomial(x, rest),
    }
}

/// Returns the integer nearest to `x`, ties to even, for `|x| <= 2^51` (2^22 in single precision); `+0` for
/// zero.
#[inline(always)]
pub(crate) fn nearest_integer<R: Real>(x: R) -> R {
    let aligner = R::constant(Format::<R>::ROUNDING_ALIGNER);
    (x + aligner) - aligner
}

/// Returns the multiple of four nearest to `x`, for `|x| <= 2^53` (2^24 in single precision); `+0` for zero.
#[inline(always)]
pub(crate) fn nearest_multiple_of_four<R: Real>(x: R) -> R {
    let aligner = R::constant(4.0 * Format::<R>::ROUNDING_ALIGNER);
    (x + aligner) - aligner
}

/// Limits `x` to `[lowest, highest]`; NaN stays NaN.
#[inline(always)]
pub(crate) fn clamp<R: Real>(x: R, lowest: f64, highest: f64) -> R {
    let (lowest, highest) = (R::constant(lowest), R::constant(highest));
    let below = R::select_less(highest, x, highest, x);
    R::select_less(x, lowest, lowest, below)
}

/// Returns `value 2^k` for integral `|k| <= 1100` (150 in single precision), rounded once if `value` is near one, also to zero, a
/// subnormal or infinity.
#[inline(always)]
pub(crate) fn scale_by_power_of_two<R: Real>(value: R, k: R) -> R {
    let first = nearest_integer(k * R::constant(0.5));
    (value * first.power_of_two()) * (k - first).power_of_two()
}

/// Returns significand in `[1, 2)` and integral exponent of a positive finite `x = significand 2^exponent`,
/// subnormals included; meaningless finite values for any other `x`.
#[inline(always)]
pub(crate) fn split_exponent<R: Real>(x: R) -> (R, R) {
    let smallest_normal = R::constant(Format::<R>::SMALLEST_NORMAL);
    let (exponent, factor) = Format::<R>::RAISING;
    let raised = x * R::constant(factor);
    let normal = R::select_less(x, smallest_normal, raised, x);
    let shift = R::select_less(x, smallest_normal, R::constant(exponent), R::constant(0.0));
    (normal.significand(), normal.exponent() - shift)
}
