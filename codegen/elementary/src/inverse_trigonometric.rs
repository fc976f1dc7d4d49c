//! Arc tangent of one argument (`atan`) and of two (`atan2`), arc sine and arc cosine.
//!
//! All arc tangents share one computation: the angle of a point `(d, n)` with `0 <= n <= d` is a constant (0, atan
//! 1/2 or pi/4) plus the arc tangent of a small ratio. Arc sine and arc cosine use a polynomial up to 1/2. Above 1/2
//! they use the half-angle formula, with the square root as a pair.

use crate::approximation::polynomial;
use crate::pair::{Pair, ordered_sum};
use crate::precision::Precision;
use crate::real::{Format, Real};
use crate::root::root_pair;

/// Ratio below which the polynomial is used directly.
const FIRST_BREAK: f64 = 0.406_25;
/// Ratio above which the constant is pi/4; between the two breaks it is `atan(1/2)`.
const SECOND_BREAK: f64 = 0.6875;

/// Computes the arc tangent, in `[-pi/2, pi/2]` radians.
///
/// Largest error measured: 0.75 ulp.
#[inline]
pub fn atan<R: Real>(x: R) -> R {
    let one = R::constant(1.0);
    // All larger slopes have the same arc tangent; an infinite slope would give NaN.
    let steepest = R::constant(Format::<R>::HUGE);
    let magnitude = R::select_less(steepest, x.abs(), steepest, x.abs());
    let steep = |then: R, otherwise: R| R::select_less(one, magnitude, then, otherwise);
    let angle = Octant {
        base: select_pair(
            steep,
            constant_pair(Format::<R>::PI[1]),
            constant_pair(ZERO),
        ),
        direction: steep(R::constant(-1.0), one),
    };
    let value = angle.add_arctan(steep(one, magnitude), steep(magnitude, one));
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
    let flat_base = select_pair(
        left_of,
        constant_pair(Format::<R>::PI[0]),
        constant_pair(ZERO),
    );
    let turned = left_of(R::constant(-1.0), one);
    let angle = Octant {
        base: select_pair(steep, constant_pair(Format::<R>::PI[1]), flat_base),
        direction: steep(-turned, turned),
    };
    let (n, d) = scale_to_range(steep(width, height), steep(height, width));
    let value = angle.add_arctan(n, d).copysign(y);
    let value = R::select_equal(x, x, value, x);
    R::select_equal(y, y, value, y)
}

/// Computes the arc sine, in `[-pi/2, pi/2]` radians; NaN outside `[-1, 1]`.
///
/// Largest error measured: 0.63 ulp.
#[inline]
pub fn asin<R: Real>(x: R) -> R {
    let half = half_angle(x);
    let outer = ordered_sum(
        R::constant(Format::<R>::PI[1].high),
        -(half.sine + half.sine),
    );
    let outer_rest = half.rest + half.rest;
    let outer = outer.high + (outer.low + (R::constant(Format::<R>::PI[1].low) - outer_rest));
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
    let base = select_pair(
        left_of,
        constant_pair(Format::<R>::PI[0]),
        constant_pair(Format::<R>::PI[1]),
    );
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

/// Selects both parts of a pair by one condition.
#[inline(always)]
fn select_pair<R: Real>(select: impl Fn(R, R) -> R, then: Pair<R>, otherwise: Pair<R>) -> Pair<R> {
    Pair {
        high: select(then.high, otherwise.high),
        low: select(then.low, otherwise.low),
    }
}

/// Octant of the plane: the angles `base + direction * a` with `a` in `[0, pi/4]`.
struct Octant<R> {
    base: Pair<R>,
    direction: R,
}

impl<R: Real> Octant<R> {
    /// Computes `base + direction * atan(n/d)` for `0 <= n <= d`, `d > 0`.
    #[inline(always)]
    fn add_arctan(self, n: R, d: R) -> R {
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
                R::constant(Format::<R>::ARCTAN_HALF.high),
                R::constant(Format::<R>::PI[2].high),
            ),
            low: centre(
                zero,
                R::constant(Format::<R>::ARCTAN_HALF.low),
                R::constant(Format::<R>::PI[2].low),
            ),
        };
        let t = (n - slope * d) / (d + slope * n);
        let z = t * t;
        let curved = (t * z) * polynomial(z, Format::<R>::ARC_TANGENT);
        let start = ordered_sum(self.base.high, self.direction * offset.high)
            .add_to_low(self.base.low + self.direction * offset.low);
        let sum = ordered_sum(start.high, self.direction * t);
        sum.high + (sum.low + (start.low - self.direction * curved))
    }
}

/// Scales `(n, d)`, `0 <= n <= d`, to a range in which products with small constants neither overflow nor lose bits.
/// The ratio is unchanged. The ratio of two infinities becomes 1, the ratio of two zeros 0.
#[inline(always)]
fn scale_to_range<R: Real>(n: R, d: R) -> (R, R) {
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    let infinity = R::constant(f64::INFINITY);
    let (down, small, up) = Format::<R>::SCALING;
    let (huge, down) = (R::constant(Format::<R>::HUGE), R::constant(down));
    let (small, up) = (R::constant(small), R::constant(up));
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
    let curved = (sine * z) * polynomial(z, Format::<R>::ARC_SINE);
    HalfAngle {
        sine,
        rest: beyond(root.low, zero) + curved,
    }
}
