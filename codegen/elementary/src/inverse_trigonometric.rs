//! Arc tangent (of a number and of a point), arc sine and arc cosine.
//!
//! All arc tangents use one core: the angle of a point `(d, n)` with `0 <= n <= d` is a centre (0, atan 1/2
//! or pi/4) plus the arc tangent of a small ratio. Arc sine and cosine use a polynomial up to 1/2, and the
//! half-angle formula with the root as a pair above it.

use crate::approximation::polynomial;
use crate::pair::{Pair, ordered_sum};
use crate::real::Real;
use crate::root::root_pair;

const PI: Pair<f64> = Pair {
    high: core::f64::consts::PI,
    low: 1.224_646_799_147_353_2e-16,
};
const HALF_PI: Pair<f64> = Pair {
    high: core::f64::consts::FRAC_PI_2,
    low: 6.123_233_995_736_766e-17,
};
const QUARTER_PI: Pair<f64> = Pair {
    high: core::f64::consts::FRAC_PI_4,
    low: 3.061_616_997_868_383e-17,
};
/// `atan(1/2)`.
const ARCTAN_HALF: Pair<f64> = Pair {
    high: 0.463_647_609_000_806_1,
    low: 2.269_877_745_296_168_7e-17,
};

/// Ratio below which the polynomial is used directly.
const FIRST_BREAK: f64 = 0.406_25;
/// Ratio above which the centre is pi/4; between the two breaks it is `atan(1/2)`.
const SECOND_BREAK: f64 = 0.6875;

/// `(1 - atan(t)/t)/z`, `z = t^2`, `|t| <= 13/32`: arc tangent to 2^-60.0.
const ARC_TANGENT: [f64; 11] = [
    0.333_333_333_333_332_4,
    -0.199_999_999_999_677_74,
    0.142_857_142_817_274_52,
    -0.111_111_108_647_920_88,
    0.090_909_002_284_327_43,
    -0.076_921_064_388_157_52,
    0.066_636_547_777_900_65,
    -0.058_520_779_995_031_746,
    0.050_589_893_714_249_747,
    -0.038_585_239_163_830_554,
    0.018_499_946_444_261_672,
];

/// `(asin(s)/s - 1)/z`, `z = s^2`, `|s| <= 1/2`: arc sine to 2^-59.8.
const ARC_SINE: [f64; 13] = [
    0.166_666_666_666_667_63,
    0.074_999_999_999_701_72,
    0.044_642_857_175_186_69,
    0.030_381_942_681_077_145,
    0.022_372_215_719_623_372,
    0.017_351_599_189_577_46,
    0.013_980_970_743_362_084,
    0.011_397_710_031_166_455,
    0.010_786_851_869_560_77,
    0.003_681_972_820_173_528_4,
    0.021_765_785_126_995_955,
    -0.021_080_136_755_579_845,
    0.032_678_452_646_137_02,
];

/// Computes the arc tangent, in `[-pi/2, pi/2]` radians.
///
/// Largest error measured: 0.75 ulp.
#[inline]
pub fn atan<R: Real>(x: R) -> R {
    let one = R::constant(1.0);
    // Larger slopes give the same result, and an infinite one would give NaN.
    let steepest = R::constant(1e300);
    let magnitude = R::select_less(steepest, x.abs(), steepest, x.abs());
    let steep = |then: R, otherwise: R| R::select_less(one, magnitude, then, otherwise);
    let angle = Octant {
        base: select_pair(steep, constant_pair(HALF_PI), constant_pair(ZERO)),
        direction: steep(R::constant(-1.0), one),
    };
    let value = angle.plus_arctan(steep(one, magnitude), steep(magnitude, one));
    value.copysign(x)
}

/// Computes the angle of the point `(x, y)` from the positive x axis, in `[-pi, pi]` radians, with the usual
/// values at zeros and infinities: `atan2(+-0, x < 0 or -0) = +-pi`, `atan2(+-0, x > 0 or +0) = +-0`,
/// multiples of pi/4 at infinity.
///
/// Largest error measured: 1.45 ulp, for ratios just above 1/16, 1/8 or 1/4.
#[inline]
pub fn atan2<R: Real>(y: R, x: R) -> R {
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    let (width, height) = (x.abs(), y.abs());
    let left_of = |then: R, otherwise: R| R::select_less(one.copysign(x), zero, then, otherwise);
    let steep = |then: R, otherwise: R| R::select_less(width, height, then, otherwise);
    let flat_base = select_pair(left_of, constant_pair(PI), constant_pair(ZERO));
    let turned = left_of(R::constant(-1.0), one);
    let angle = Octant {
        base: select_pair(steep, constant_pair(HALF_PI), flat_base),
        direction: steep(-turned, turned),
    };
    let (n, d) = scale_to_range(steep(width, height), steep(height, width));
    let value = angle.plus_arctan(n, d).copysign(y);
    let value = R::select_equal(x, x, value, x);
    R::select_equal(y, y, value, y)
}

/// Computes the arc sine, in `[-pi/2, pi/2]` radians; NaN outside `[-1, 1]`.
///
/// Largest error measured: 0.63 ulp.
#[inline]
pub fn asin<R: Real>(x: R) -> R {
    let half = half_angle(x);
    let outer = ordered_sum(R::constant(HALF_PI.high), -(half.sine + half.sine));
    let outer_rest = half.rest + half.rest;
    let outer = outer.high + (outer.low + (R::constant(HALF_PI.low) - outer_rest));
    let inner = half.sine + half.rest;
    R::select_less(R::constant(0.5), x.abs(), outer, inner).copysign(x)
}

/// Computes the arc cosine, in `[0, pi]` radians; NaN outside `[-1, 1]`.
///
/// Largest error measured: 0.60 ulp.
#[inline]
pub fn acos<R: Real>(x: R) -> R {
    let (one, two) = (R::constant(1.0), R::constant(2.0));
    let (bound, lower_bound) = (R::constant(0.5), R::constant(-0.5));
    let right_of = |then: R, otherwise: R| R::select_less(bound, x, then, otherwise);
    let left_of = |then: R, otherwise: R| R::select_less(x, lower_bound, then, otherwise);
    let half = half_angle(x);
    let base = select_pair(left_of, constant_pair(PI), constant_pair(HALF_PI));
    let base = select_pair(right_of, constant_pair(ZERO), base);
    let factor = right_of(two, left_of(R::constant(-2.0), -one.copysign(x)));
    let sum = ordered_sum(base.high, factor * half.sine);
    sum.high + (sum.low + (base.low + factor * half.rest))
}

const ZERO: Pair<f64> = Pair {
    high: 0.0,
    low: 0.0,
};

fn constant_pair<R: Real>(pair: Pair<f64>) -> Pair<R> {
    Pair {
        high: R::constant(pair.high),
        low: R::constant(pair.low),
    }
}

/// Selects both parts by the same condition.
#[inline(always)]
fn select_pair<R: Real>(select: impl Fn(R, R) -> R, then: Pair<R>, otherwise: Pair<R>) -> Pair<R> {
    Pair {
        high: select(then.high, otherwise.high),
        low: select(then.low, otherwise.low),
    }
}

/// Octant of the plane: angles `base + direction * a` with `a` in `[0, pi/4]`.
struct Octant<R> {
    base: Pair<R>,
    direction: R,
}

impl<R: Real> Octant<R> {
    /// Computes `base + direction * atan(n/d)` for `0 <= n <= d`, `d > 0`.
    #[inline(always)]
    fn plus_arctan(self, n: R, d: R) -> R {
        let (zero, one) = (R::constant(0.0), R::constant(1.0));
        let first_break = d * R::constant(FIRST_BREAK);
        let second_break = d * R::constant(SECOND_BREAK);
        let centre = |low: R, middle: R, high: R| {
            let upper = R::select_less(n, second_break, middle, high);
            R::select_less(n, first_break, low, upper)
        };
        let slope = centre(zero, R::constant(0.5), one);
        let offset = Pair {
            high: centre(
                zero,
                R::constant(ARCTAN_HALF.high),
                R::constant(QUARTER_PI.high),
            ),
            low: centre(
                zero,
                R::constant(ARCTAN_HALF.low),
                R::constant(QUARTER_PI.low),
            ),
        };
        let t = (n - slope * d) / (d + slope * n);
        let z = t * t;
        let curved = (t * z) * polynomial(z, &ARC_TANGENT);
        let start = ordered_sum(self.base.high, self.direction * offset.high)
            .plus_low(self.base.low + self.direction * offset.low);
        let sum = ordered_sum(start.high, self.direction * t);
        sum.high + (sum.low + (start.low - self.direction * curved))
    }
}

/// Factor `2^-30`, for which three times the largest double stays finite.
const SCALE_DOWN: f64 = 1.0 / (1_u64 << 30) as f64;
/// Factor `2^120`, which makes any subnormal normal.
const SCALE_UP: f64 = (1_u128 << 120) as f64;

/// Scales `(n, d)`, `0 <= n <= d`, to a range in which products with small constants neither overflow nor
/// lose bits. The ratio is unchanged; that of infinities becomes 1, that of zeros 0.
#[inline(always)]
fn scale_to_range<R: Real>(n: R, d: R) -> (R, R) {
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    let infinity = R::constant(f64::INFINITY);
    let (huge, down) = (R::constant(1e300), R::constant(SCALE_DOWN));
    let (small, up) = (R::constant(1e-270), R::constant(SCALE_UP));
    let scale = R::select_less(huge, d, down, R::select_less(d, small, up, one));
    let n_at_infinity = R::select_equal(n, infinity, one, zero);
    let d_scaled = R::select_equal(d, zero, one, d * scale);
    (
        R::select_equal(d, infinity, n_at_infinity, n * scale),
        R::select_equal(d, infinity, one, d_scaled),
    )
}

/// `asin(|x|)` if `|x| <= 1/2`, else `asin(sqrt((1 - |x|)/2))`, as `sine + rest`.
struct HalfAngle<R> {
    sine: R,
    rest: R,
}

#[inline(always)]
fn half_angle<R: Real>(x: R) -> HalfAngle<R> {
    let (zero, half) = (R::constant(0.0), R::constant(0.5));
    let magnitude = x.abs();
    let beyond = |then: R, otherwise: R| R::select_less(half, magnitude, then, otherwise);
    let complement = (R::constant(1.0) - magnitude) * half;
    let root = root_pair(complement);
    let z = beyond(complement, magnitude * magnitude);
    let sine = beyond(root.high, magnitude);
    let curved = (sine * z) * polynomial(z, &ARC_SINE);
    HalfAngle {
        sine,
        rest: beyond(root.low, zero) + curved,
    }
}
