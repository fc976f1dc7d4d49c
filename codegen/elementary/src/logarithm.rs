//! Natural logarithm, rounded to one number, and as a pair of numbers for powers.
//!
//! `x = 2^k m` with `m` in `[sqrt(1/2), sqrt 2)`, `f = m - 1`, `s = f/(2 + f)`:
//! `ln x = k ln 2 + 2 artanh s`.

use crate::approximation::{polynomial, split_exponent};
use crate::pair::{Pair, exact_product, exact_square, ordered_sum, quotient};
use crate::precision::Precision;
use crate::real::{Format, Real};

/// Computes the natural logarithm; minus infinity at zero, NaN for negative arguments.
///
/// Largest error measured: 0.81 ulp.
#[inline]
pub fn ln<R: Real>(x: R) -> R {
    let (k, m) = centre_significand(x);
    let f = m - R::constant(1.0);
    let s = f / (R::constant(2.0) + f);
    let z = s * s;
    // 2 s = f - s f and s f = f^2/2 - s f^2/2: the leading term f is exact.
    let half_square = f * f * R::constant(0.5);
    let curved = s * (half_square + z * polynomial(z, Format::<R>::LOGARITHM));
    let fraction = half_square - (curved + k * R::constant(Format::<R>::LN_2.low));
    let value = k * R::constant(Format::<R>::LN_2.high) - (fraction - f);
    with_special_cases(x, value)
}

/// Computes the natural logarithm of a positive finite `x` with a relative error below 2^-64 (2^-34 in single
/// precision). For any other argument the result is a meaningless finite pair.
#[inline(always)]
pub(crate) fn logarithm_pair<R: Real>(x: R) -> Pair<R> {
    let one = R::constant(1.0);
    let (k, m) = centre_significand(x);
    let sum = m + one;
    let denominator = Pair {
        high: sum,
        low: m - (sum - one),
    };
    let numerator = Pair {
        high: m - one,
        low: R::constant(0.0),
    };
    let s = quotient(numerator, denominator);
    let cubic = cubic_part(s);
    let fraction = ordered_sum(s.high, cubic.high).add_to_low(s.low + cubic.low);
    let two = R::constant(2.0);
    let low = fraction.low * two + k * R::constant(Format::<R>::LN_2.low);
    ordered_sum(k * R::constant(Format::<R>::LN_2.high), fraction.high * two)
        .add_to_low(low)
        .normalise()
}

/// Computes `artanh(s) - s` as a pair.
#[inline(always)]
fn cubic_part<R: Real>(s: Pair<R>) -> Pair<R> {
    let square = exact_square(s.high);
    let square = square.add_to_low(s.high * s.low * R::constant(2.0));
    let beyond = square.high * polynomial(square.high, Format::<R>::LOGARITHM_BEYOND_CUBE);
    let factor = ordered_sum(R::constant(Format::<R>::ONE_THIRD.high), beyond);
    let factor = factor.add_to_low(R::constant(Format::<R>::ONE_THIRD.low));
    product(s, product(square, factor))
}

/// Multiplies two pairs; the product of their low parts is neglected.
#[inline(always)]
fn product<R: Real>(a: Pair<R>, b: Pair<R>) -> Pair<R> {
    exact_product(a.high, b.high).add_to_low(a.high * b.low + a.low * b.high)
}

/// Returns `(k, m)` with `x = 2^k m`, `m` in `(sqrt(1/2), sqrt 2]`.
#[inline(always)]
fn centre_significand<R: Real>(x: R) -> (R, R) {
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    let root_two = R::constant(core::f64::consts::SQRT_2);
    let (m, k) = split_exponent(x);
    let raised = R::select_less(root_two, m, one, zero);
    let factor = R::select_less(root_two, m, R::constant(0.5), one);
    (k + raised, m * factor)
}

/// Returns `value` for positive finite `x`, minus infinity at zero, infinity at infinity, and NaN otherwise.
#[inline(always)]
fn with_special_cases<R: Real>(x: R, value: R) -> R {
    let zero = R::constant(0.0);
    let value = R::select_less(x, R::constant(f64::INFINITY), value, x);
    let value = R::select_less(x, zero, R::constant(f64::NAN), value);
    R::select_equal(x, zero, R::constant(f64::NEG_INFINITY), value)
}
