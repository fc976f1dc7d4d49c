//! Square root, correctly rounded and thus bit-identical to a hardware square root.
//!
//! The argument is `x = 4^h m` with `m` in `[1, 4)`. A polynomial approximates `1/sqrt m`; Newton steps and one step
//! with the exact remainder improve it. A final comparison of the exact remainder with half a unit in the last place
//! gives the correct rounding.

use crate::approximation::{nearest_integer, polynomial, split_exponent};
use crate::pair::{Pair, exact_square};
use crate::precision::Precision;
use crate::real::{Format, Real};

/// Computes the square root, correctly rounded; NaN for negative arguments, `-0` for `-0`.
#[inline]
pub fn sqrt<R: Real>(x: R) -> R {
    let zero = R::constant(0.0);
    let centred = CentredNumber::new(x);
    let root = centred.rounded_root() * centred.scale;
    let root = R::select_less(x, R::constant(f64::INFINITY), root, x);
    let root = R::select_less(x, zero, R::constant(f64::NAN), root);
    R::select_equal(x, zero, x, root)
}

/// Computes the square root of a finite `x` as a pair, to about 90 bits (40 in single precision); NaN for negative `x`.
#[inline(always)]
pub(crate) fn root_pair<R: Real>(x: R) -> Pair<R> {
    let zero = R::constant(0.0);
    let centred = CentredNumber::new(x);
    let root = centred.root().normalise();
    let high = R::select_less(zero, x, root.high * centred.scale, x);
    Pair {
        high: R::select_less(x, zero, R::constant(f64::NAN), high),
        low: R::select_equal(x, zero, zero, root.low * centred.scale),
    }
}

/// Positive finite number, written as `m scale^2` with `m` in `[1, 4)`, and half of `1/sqrt m`.
struct CentredNumber<R> {
    m: R,
    scale: R,
    half_inverse: R,
}

impl<R: Real> CentredNumber<R> {
    #[inline(always)]
    fn new(x: R) -> Self {
        let half = R::constant(0.5);
        let (significand, exponent) = split_exponent(x);
        let halved = nearest_integer(exponent * half - R::constant(0.25));
        let odd = exponent - (halved + halved);
        let m = significand * (odd + R::constant(1.0));
        let mut inverse = polynomial(m, Format::<R>::INVERSE_ROOT);
        for _ in 0..Format::<R>::NEWTON_STEPS {
            inverse = newton(m, inverse);
        }
        CentredNumber {
            m,
            scale: halved.power_of_two(),
            half_inverse: inverse * half,
        }
    }

    /// Computes the root of `m`: a value accurate to 2^-46 (2^-20 in single precision) and its
    /// correction, which doubles the bits.
    #[inline(always)]
    fn root(&self) -> Pair<R> {
        let high = self.m * (self.half_inverse + self.half_inverse);
        Pair {
            high,
            low: self.remainder(high) * self.half_inverse,
        }
    }

    /// Computes the correctly rounded root of `m`.
    ///
    /// The rounded pair `r` can be on the wrong side of a near tie. Its remainder `m - r^2` is exact. Let u be a unit
    /// in the last place. The root exceeds `r` by more than u/2 if and only if the remainder exceeds `r u`; the
    /// opposite side is analogous.
    #[inline(always)]
    fn rounded_root(&self) -> R {
        let root = self.root().round();
        let last_place = R::constant(Format::<R>::EPSILON);
        let threshold = root * last_place;
        let left = self.remainder(root);
        let not_above = R::select_less(-threshold, left, root, root - last_place);
        R::select_less(threshold, left, root + last_place, not_above)
    }

    /// Computes `m - root^2`.
    #[inline(always)]
    fn remainder(&self, root: R) -> R {
        let square = exact_square(root);
        (self.m - square.high) - square.low
    }
}

/// Computes one Newton step for `1/sqrt m`.
#[inline(always)]
fn newton<R: Real>(m: R, inverse: R) -> R {
    let defect = R::constant(1.0) - (m * inverse) * inverse;
    inverse + (inverse * R::constant(0.5)) * defect
}
