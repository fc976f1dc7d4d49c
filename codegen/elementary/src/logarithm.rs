//! Natural logarithm, rounded, and as a pair of doubles for powers.
//!
//! `x = 2^k m` with `m` in `[sqrt(1/2), sqrt 2)`, `f = m - 1`, `s = f/(2 + f)`:
//! `ln x = k ln 2 + 2 artanh s`.

use crate::approximation::{polynomial, split_exponent};
use crate::exponential::{LN_2_HIGH, LN_2_LOW};
use crate::pair::{Pair, exact_product, exact_square, ordered_sum, quotient};
use crate::real::Real;

/// `(2 artanh(s)/s - 2)/z`, `z = s^2`, `|s| <= (sqrt 2 - 1)/(sqrt 2 + 1)`: logarithm to 2^-58.5.
const LOGARITHM: [f64; 7] = [
    0.666_666_666_666_673_4,
    0.399_999_999_994_166_47,
    0.285_714_287_420_412_05,
    0.222_221_986_023_973_25,
    0.181_835_630_409_943_4,
    0.153_140_790_370_342_92,
    0.147_956_981_892_253_4,
];

/// `(artanh(s)/s - 1 - z/3)/z^2` on the same interval: logarithm to 2^-73.3.
const LOGARITHM_BEYOND_CUBE: [f64; 8] = [
    0.199_999_999_999_999_9,
    0.142_857_142_857_219_2,
    0.111_111_111_088_948_76,
    0.090_909_094_219_955_27,
    0.076_922_792_141_128_09,
    0.066_681_322_726_506_69,
    0.058_378_893_992_871_744,
    0.059_908_896_471_751_4,
];

const ONE_THIRD: Pair<f64> = Pair {
    high: 0.333_333_333_333_333_3,
    low: 1.850_371_707_708_594e-17,
};

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
    let curved = s * (half_square + z * polynomial(z, &LOGARITHM));
    let fraction = half_square - (curved + k * R::constant(LN_2_LOW));
    let value = k * R::constant(LN_2_HIGH) - (fraction - f);
    with_special_cases(x, value)
}

/// Computes the natural logarithm of a positive finite `x` with a relative error below 2^-64; a meaningless
/// finite pair for any other argument.
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
    let fraction = ordered_sum(s.high, cubic.high).plus_low(s.low + cubic.low);
    let two = R::constant(2.0);
    let low = fraction.low * two + k * R::constant(LN_2_LOW);
    ordered_sum(k * R::constant(LN_2_HIGH), fraction.high * two)
        .plus_low(low)
        .normalise()
}

/// Computes `artanh(s) - s` as a pair.
#[inline(always)]
fn cubic_part<R: Real>(s: Pair<R>) -> Pair<R> {
    let square = exact_square(s.high);
    let square = square.plus_low(s.high * s.low * R::constant(2.0));
    let beyond = square.high * polynomial(square.high, &LOGARITHM_BEYOND_CUBE);
    let factor = ordered_sum(R::constant(ONE_THIRD.high), beyond);
    let factor = factor.plus_low(R::constant(ONE_THIRD.low));
    product(s, product(square, factor))
}

/// Multiplies two pairs without the product of their low parts.
#[inline(always)]
fn product<R: Real>(a: Pair<R>, b: Pair<R>) -> Pair<R> {
    exact_product(a.high, b.high).plus_low(a.high * b.low + a.low * b.high)
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

/// Returns `value` for positive finite `x`, else the limits and NaN.
#[inline(always)]
fn with_special_cases<R: Real>(x: R, value: R) -> R {
    let zero = R::constant(0.0);
    let value = R::select_less(x, R::constant(f64::INFINITY), value, x);
    let value = R::select_less(x, zero, R::constant(f64::NAN), value);
    R::select_equal(x, zero, R::constant(f64::NEG_INFINITY), value)
}
