//! Building blocks of the functions: polynomials, rounding to an integer, clamping, and the split into
//! significand and exponent.

use crate::precision::Precision;
use crate::real::{Format, Real};

/// Largest number of coefficients of a polynomial.
const MAX_COEFFICIENTS: usize = 13;

/// Computes the polynomial `sum of coefficients[i] x^i` by Estrin's scheme: adjacent coefficients are combined with
/// `x`, the results with `x^2`, then with `x^4`, and so on. The order of summation is fixed, and the dependency chain
/// is short.
#[inline(always)]
pub(crate) fn polynomial<R: Real>(x: R, coefficients: &[f64]) -> R {
    let mut terms = [R::constant(0.0); MAX_COEFFICIENTS];
    for (term, coefficient) in terms.iter_mut().zip(coefficients) {
        *term = R::constant(*coefficient);
    }
    let mut length = coefficients.len().min(MAX_COEFFICIENTS);
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

/// Computes the polynomial by Horner's scheme, which needs the fewest operations.
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

/// Returns `value 2^k` for integral `|k| <= 1100` (150 in single precision). If `value` is near one, the result is
/// rounded once, also if it is zero, subnormal or infinite.
#[inline(always)]
pub(crate) fn scale_by_power_of_two<R: Real>(value: R, k: R) -> R {
    let first = nearest_integer(k * R::constant(0.5));
    (value * first.power_of_two()) * (k - first).power_of_two()
}

/// Returns the significand in `[1, 2)` and the integral exponent of a positive finite `x = significand 2^exponent`,
/// subnormals included. For any other `x` the results are finite but meaningless.
#[inline(always)]
pub(crate) fn split_exponent<R: Real>(x: R) -> (R, R) {
    let smallest_normal = R::constant(Format::<R>::SMALLEST_NORMAL);
    let (exponent, factor) = Format::<R>::SUBNORMAL_SCALING;
    let raised = x * R::constant(factor);
    let normal = R::select_less(x, smallest_normal, raised, x);
    let shift = R::select_less(x, smallest_normal, R::constant(exponent), R::constant(0.0));
    (normal.significand(), normal.exponent() - shift)
}
