//! Sine, cosine and tangent.
//!
//! All three use the same argument reduction: `x = k pi/2 + r`, `|r| <= pi/4`, with the remainder r as a pair. In
//! double precision `pi/2` is split into four parts of 23 bits and a rest, so that the product of `k` (at most 30
//! bits up to [`LARGEST_ANGLE`]) with each of the four is exact. Doubles below 1e9 differ from a multiple of `pi/2`
//! by at least about 2^-60; the parts have 145 bits together, which is sufficient for these arguments, too. In single
//! precision the parts have 8 bits, for a `k` of 16 bits up to 1e5; numbers below 1e5 differ from a multiple of
//! `pi/2` by at least 2^-28.
//!
//! In single precision, sine and cosine use a shorter remainder and no selection. Rounding errors of this remainder
//! are compensated only if they exceed half a unit of the result.

use crate::approximation::{
    nearest_integer, nearest_multiple_of_four, polynomial, short_polynomial,
};
use crate::pair::{Pair, ordered_sum, quotient};
use crate::precision::{Double, Precision, Single};
use crate::real::{Format, Real};

/// Largest magnitude, in radians, of an argument of sine, cosine and tangent in double precision; they are NaN
/// for larger arguments, infinities and NaN.
pub const LARGEST_ANGLE: f64 = Double::LARGEST_ANGLE;

/// Largest magnitude, in radians, of an argument of sine, cosine and tangent in single precision.
pub const LARGEST_SINGLE_ANGLE: f32 = Single::LARGEST_ANGLE as f32;

/// Result of the reduction: sine and cosine of the remainder, and the quadrant.
struct ReducedAngle<R> {
    /// `sin(r)`, not rounded.
    sine: Pair<R>,
    /// `cos(r)`, not rounded.
    cosine: Pair<R>,
    /// `k` modulo 4, as one of -2, -1, 0, 1, 2; NaN above the largest angle.
    quadrant: R,
}

/// Computes the sine of `x` radians; NaN above the largest angle.
///
/// Largest error measured: 0.76 ulp; 1.72 ulp in single precision up to 1e5.
#[inline]
pub fn sin<R: Real>(x: R) -> R {
    sin_cos(x).0
}

/// Computes the cosine of `x` radians; NaN above the largest angle.
///
/// Largest error measured: 0.77 ulp; 1.76 ulp in single precision up to 1e5.
#[inline]
pub fn cos<R: Real>(x: R) -> R {
    sin_cos(x).1
}

/// Computes sine and cosine of `x` radians, bit-identical to [`sin`] and [`cos`], at little more than the cost of one
/// of them.
#[inline]
pub fn sin_cos<R: Real>(x: R) -> (R, R) {
    match Format::<R>::SHORT_REMAINDER {
        Some(overflowing) => short_sin_cos(x, overflowing),
        None => compensated_sin_cos(x),
    }
}

/// Computes sine and cosine from a remainder that is a pair.
#[inline(always)]
fn compensated_sin_cos<R: Real>(x: R) -> (R, R) {
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

/// Computes sine and cosine from a remainder that is one number and the error of its second rounding. [`remainder`]
/// defines the parts and `k`.
///
/// With `q = -k` modulo 4, `e = 1 - |q|` and `o = q (2 - |q|)`, `sin x = e sin r - o cos r` and `cos x = e cos r +
/// o sin r`: one of the two products is zero and the other exact. The product with `overflowing` is infinite
/// above the largest angle, and its difference from itself is then NaN, else zero.
#[inline(always)]
fn short_sin_cos<R: Real>(x: R, overflowing: f64) -> (R, R) {
    let one = R::constant(1.0);
    let [first, second, third, fourth, rest] = Format::<R>::HALF_PI_PARTS.map(R::constant);
    let scaled = x * R::constant(overflowing);
    let rounded = nearest_integer(x * R::constant(core::f64::consts::FRAC_2_PI));
    #[expect(clippy::eq_op, reason = "NaN for an infinite product")]
    let k = rounded - (scaled - scaled);
    let leading = (x - k * first) - k * second;
    let (third, fourth) = (k * third, k * fourth);
    let near = leading - third;
    let lost = (leading - near) - third;
    let middle = near - fourth;
    let low = k * rest - lost;
    let r = middle - low;
    let z = r * r;
    let sine = middle - ((r * z) * short_polynomial(z, Format::<R>::SINE) + low);
    let curved = R::constant(-0.5) + z * short_polynomial(z, Format::<R>::COSINE);
    let cosine = one + z * curved;
    let q = nearest_multiple_of_four(k) - k;
    let even = one - q.abs();
    let odd = q * (R::constant(2.0) - q.abs());
    (sine * even - cosine * odd, cosine * even + sine * odd)
}

/// Computes the tangent of `x` radians; NaN above the largest angle.
///
/// Largest error measured: 0.94 ulp.
#[inline]
pub fn tan<R: Real>(x: R) -> R {
    let one = R::constant(1.0);
    let ReducedAngle {
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
    // The quadrant is NaN for angles above the largest angle.
    R::select_equal(quadrant, quadrant, tangent, quadrant)
}

/// Computes sine and cosine of the remainder, and the quadrant. The low part of the sine must be *subtracted*, so
/// that a negative zero keeps its sign.
#[inline(always)]
fn reduce<R: Real>(x: R) -> ReducedAngle<R> {
    let k = nearest_integer(x * R::constant(core::f64::consts::FRAC_2_PI));
    let (r, excess) = remainder(x, k);
    let one = R::constant(1.0);
    let z = r * r;
    let near_cosine = ordered_sum(one, z * R::constant(-0.5));
    let sine_rest = (r * z) * polynomial(z, Format::<R>::SINE) + excess * near_cosine.high;
    let cosine_rest = (z * z) * polynomial(z, Format::<R>::COSINE) + r * excess;
    ReducedAngle {
        sine: Pair {
            high: r,
            low: sine_rest,
        },
        cosine: near_cosine.add_to_low(cosine_rest),
        quadrant: quadrant(x, k),
    }
}

/// Returns `x - k pi/2` as `r - excess`.
///
/// The first two subtractions are exact, because the results are multiples of 2^-53 below one, or of the last
/// place of `x`. The third is exact together with its rounding error (see [`ordered_sum`]).
#[inline(always)]
fn remainder<R: Real>(x: R, k: R) -> (R, R) {
    let [first, second, third, fourth, rest] = Format::<R>::HALF_PI_PARTS.map(R::constant);
    let leading = (x - k * first) - k * second;
    let tail = ordered_sum(k * third, k * fourth).add_to_low(k * rest);
    let r = leading - tail.high;
    let lost = (leading - r) - tail.high;
    (r, tail.low - lost)
}

/// Returns `k` modulo 4 between -2 and 2, NaN if `x` is above the largest angle.
#[inline(always)]
fn quadrant<R: Real>(x: R, k: R) -> R {
    let turns = nearest_integer(k * R::constant(0.25));
    let quadrant = k - turns * R::constant(4.0);
    let largest = R::constant(Format::<R>::LARGEST_ANGLE);
    R::select_less(largest, x.abs(), R::constant(f64::NAN), quadrant)
}
