//! Sine, cosine and tangent.
//!
//! One reduction serves all three: `x = k pi/2 + r`, `|r| <= pi/4`, with the remainder as a pair of doubles.
//! `pi/2` is split into four parts of 23 bits and a remainder, so that the product of `k` (at most 30 bits up
//! to [`LARGEST_ANGLE`]) with each of the four is exact. Doubles below 1e9 differ from a multiple of `pi/2`
//! by at least about 2^-60; the parts have 145 bits, which suffices for these too.

use crate::approximation::{nearest_integer, polynomial};
use crate::pair::{Pair, ordered_sum, quotient};
use crate::real::Real;

/// Largest magnitude, in radians, of an argument of sine, cosine and tangent; they are NaN for larger
/// arguments, infinities and NaN.
pub const LARGEST_ANGLE: f64 = 1e9;

/// `pi/2` in parts: multiples of 2^-22, 2^-45, 2^-68, 2^-91, and the remainder.
const HALF_PI_PARTS: [f64; 5] = [
    1.570_796_251_296_997,
    7.549_789_415_861_596e-8,
    5.390_304_224_023_659e-15,
    -1.365_865_426_710_064_5e-21,
    -1.135_111_860_752_220_2e-28,
];

/// `(1 - sin(r)/r)/z`, `z = r^2`, `|r| <= pi/4`: sine to 2^-57.9.
const SINE: [f64; 6] = [
    0.166_666_666_666_666_3,
    -0.008_333_333_333_321_917,
    0.000_198_412_698_294_584_53,
    -2.755_731_358_278_338e-6,
    2.505_074_247_785_225_2e-8,
    -1.589_595_656_566_405_4e-10,
];

/// `(cos(r) - 1 + z/2)/z^2`, `z = r^2`, `|r| <= pi/4`: cosine to 2^-63.7.
const COSINE: [f64; 6] = [
    0.041_666_666_666_666_595,
    -0.001_388_888_888_887_334_2,
    2.480_158_728_900_197_8e-5,
    -2.755_731_421_694_031e-7,
    2.087_570_531_942_464_2e-9,
    -1.135_873_832_348_000_3e-11,
];

/// Result of the reduction: sine and cosine of the remainder, and the quadrant.
struct Reduced<R> {
    /// `sin(r)`, not rounded.
    sine: Pair<R>,
    /// `cos(r)`, not rounded.
    cosine: Pair<R>,
    /// `k` modulo 4, as one of -2, -1, 0, 1, 2; NaN above the largest angle.
    quadrant: R,
}

/// Computes the sine of `x` radians; NaN above [`LARGEST_ANGLE`].
///
/// Largest error measured: 0.76 ulp.
#[inline]
pub fn sin<R: Real>(x: R) -> R {
    sin_cos(x).0
}

/// Computes the cosine of `x` radians; NaN above [`LARGEST_ANGLE`].
///
/// Largest error measured: 0.77 ulp.
#[inline]
pub fn cos<R: Real>(x: R) -> R {
    sin_cos(x).1
}

/// Computes sine and cosine of `x` radians, with the bits of [`sin`] and [`cos`], at little more than the
/// cost of one.
#[inline]
pub fn sin_cos<R: Real>(x: R) -> (R, R) {
    let one = R::constant(1.0);
    let reduced = reduce(x);
    let sine = reduced.sine.high - reduced.sine.low;
    let cosine = reduced.cosine.round();
    let quadrant = reduced.quadrant;
    let even_sign = one - quadrant.abs();
    let odd = quadrant.abs();
    let sine_sign = R::select_equal(odd, one, quadrant, even_sign);
    let cosine_sign = R::select_equal(odd, one, -quadrant, even_sign);
    (
        R::select_equal(odd, one, cosine, sine) * sine_sign,
        R::select_equal(odd, one, sine, cosine) * cosine_sign,
    )
}

/// Computes the tangent of `x` radians; NaN above [`LARGEST_ANGLE`].
///
/// Largest error measured: 0.94 ulp.
#[inline]
pub fn tan<R: Real>(x: R) -> R {
    let one = R::constant(1.0);
    let Reduced {
        sine,
        cosine,
        quadrant,
    } = reduce(x);
    let sine = ordered_sum(sine.high, -sine.low);
    let cosine = ordered_sum(cosine.high, cosine.low);
    let odd = quadrant.abs();
    let swap = |then: R, otherwise: R| R::select_equal(odd, one, then, otherwise);
    let numerator = Pair {
        high: swap(-cosine.high, sine.high),
        low: swap(-cosine.low, sine.low),
    };
    let denominator = Pair {
        high: swap(sine.high, cosine.high),
        low: swap(sine.low, cosine.low),
    };
    let ratio = quotient(numerator, denominator);
    let tangent = ratio.high - (-ratio.low);
    // The quadrant is NaN for angles above the largest.
    R::select_equal(quadrant, quadrant, tangent, quadrant)
}

/// Computes sine, cosine and quadrant of the remainder. The low part of the sine must be *subtracted*, so
/// that a negative zero keeps its sign.
#[inline(always)]
fn reduce<R: Real>(x: R) -> Reduced<R> {
    let k = nearest_integer(x * R::constant(core::f64::consts::FRAC_2_PI));
    let (r, excess) = remainder(x, k);
    let one = R::constant(1.0);
    let z = r * r;
    let near_cosine = ordered_sum(one, z * R::constant(-0.5));
    let sine_rest = (r * z) * polynomial(z, &SINE) + excess * near_cosine.high;
    let cosine_rest = (z * z) * polynomial(z, &COSINE) + r * excess;
    Reduced {
        sine: Pair {
            high: r,
            low: sine_rest,
        },
        cosine: near_cosine.plus_low(cosine_rest),
        quadrant: quadrant(x, k),
    }
}

/// Returns `x - k pi/2` as `r - excess`.
///
/// The first two subtractions are exact, because the results are multiples of 2^-53 below one, or of the last
/// place of `x`. The third is exact together with its rounding error (see [`ordered_sum`]).
#[inline(always)]
fn remainder<R: Real>(x: R, k: R) -> (R, R) {
    let [first, second, third, fourth, rest] = HALF_PI_PARTS.map(R::constant);
    let leading = (x - k * first) - k * second;
    let tail = ordered_sum(k * third, k * fourth).plus_low(k * rest);
    let r = leading - tail.high;
    let lost = (leading - r) - tail.high;
    (r, tail.low - lost)
}

/// Returns `k` modulo 4 between -2 and 2, NaN if `x` is above the largest angle.
#[inline(always)]
fn quadrant<R: Real>(x: R, k: R) -> R {
    let turns = nearest_integer(k * R::constant(0.25));
    let quadrant = k - turns * R::constant(4.0);
    let largest = R::constant(LARGEST_ANGLE);
    R::select_less(largest, x.abs(), R::constant(f64::NAN), quadrant)
}
