//! Powers with a real exponent: `x^y = e^(y ln|x|)`, with logarithm and product as pairs. The special cases are those
//! of `pow` in IEEE 754.

use crate::approximation::clamp;
use crate::exponential::exponential_of_pair;
use crate::logarithm::logarithm_pair;
use crate::pair::{Pair, exact_product};
use crate::precision::Precision;
use crate::real::{Format, Real};

/// Computes `x^y`.
///
/// `x^0 = 1` and `1^y = 1` for every x and y, NaN included; otherwise NaN gives NaN. A negative `x` gives NaN unless
/// `y` is an integer; the power is negative if `y` is odd. Powers of zero and infinity are zero or infinity, negative
/// for a negative `x` and an odd `y`.
///
/// Largest error measured: 0.76 ulp.
#[inline]
pub fn pow<R: Real>(x: R, y: R) -> R {
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    let magnitude = power_of_magnitude(x.abs(), y);
    let (integral, odd) = (is_integral(y), is_odd(y));
    let sign = R::select_equal(odd, one, one.copysign(x), one);
    let value = magnitude * sign;
    let undefined = R::select_less(
        R::constant(f64::NEG_INFINITY),
        x,
        R::constant(f64::NAN),
        value,
    );
    let for_negative = R::select_equal(integral, one, value, undefined);
    let value = R::select_less(x, zero, for_negative, value);
    let value = R::select_equal(x, x, value, x);
    let value = R::select_equal(y, y, value, y);
    let value = R::select_equal(x, one, one, value);
    R::select_equal(y, zero, one, value)
}

/// Computes `a^y` for `a >= 0`. If an argument is NaN, the result is meaningless.
#[inline(always)]
fn power_of_magnitude<R: Real>(a: R, y: R) -> R {
    let (zero, infinity) = (R::constant(0.0), R::constant(f64::INFINITY));
    let logarithm = logarithm_pair(a);
    let limited = clamp(
        y,
        -Format::<R>::LARGEST_EXPONENT,
        Format::<R>::LARGEST_EXPONENT,
    );
    let product = exact_product(limited, logarithm.high).add_to_low(limited * logarithm.low);
    // If the leading part is far out of range, its correction is larger than a rounding error.
    let (lowest, highest) = Format::<R>::EXPONENTIAL_RANGE;
    let near = R::constant(Format::<R>::CORRECTED_RANGE);
    let value = exponential_of_pair(Pair {
        high: clamp(product.high, lowest, highest),
        low: R::select_less(product.high.abs(), near, product.low, zero),
    });
    let growth = R::select_equal(a, zero, -y, y);
    let limit = R::select_less(zero, growth, infinity, zero);
    let value = R::select_equal(a, infinity, limit, value);
    R::select_equal(a, zero, limit, value)
}

/// Returns 1 if `y` is an integer (or infinite), else 0.
#[inline(always)]
fn is_integral<R: Real>(y: R) -> R {
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    let bound = R::constant(Format::<R>::ALL_INTEGERS);
    let magnitude = y.abs();
    let rounded = (magnitude + bound) - bound;
    let rounded = R::select_less(magnitude, bound, rounded, magnitude);
    R::select_equal(rounded, magnitude, one, zero)
}

/// Returns 1 if `y` is an odd integer, else 0.
#[inline(always)]
fn is_odd<R: Real>(y: R) -> R {
    is_integral(y) - is_integral(y * R::constant(0.5))
}
