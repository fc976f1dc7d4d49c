//! Numbers with a scale of their rounding error. Each number carries the magnitude of the largest term that contributed
//! to it. Operations propagate this magnitude as they propagate an error of the term. This is a running error analysis
//! (Wilkinson, Higham) in units of one rounding. Without cancellation, the magnitude equals the absolute value of the
//! number. After cancellation, it bounds the accuracy of the number.
//!
//! The values are identical to plain `f64` arithmetic. Dual numbers over this type also give the magnitudes of
//! derivatives.

use num_dual::{DualNum, DualStruct, Mappable};
use num_traits::{FromPrimitive, Inv, Num, One, Signed, Zero};
use std::cmp::Ordering;
use std::fmt;
use std::iter::{Product, Sum};
use std::ops::{
    Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Rem, RemAssign, Sub, SubAssign,
};

/// Value with the magnitude of its terms.
#[derive(Clone, Copy, Debug, Default)]
pub struct Conditioned {
    /// Value, as computed in plain `f64`.
    pub value: f64,
    /// Largest magnitude among the terms, at least that of the value.
    pub magnitude: f64,
}

impl Conditioned {
    /// Creates a number; the magnitude is at least that of the value.
    pub fn new(value: f64, magnitude: f64) -> Self {
        Self {
            value,
            magnitude: value.abs().max(magnitude),
        }
    }

    /// Returns true if value and magnitude are finite.
    pub fn is_finite(self) -> bool {
        self.value.is_finite() && self.magnitude.is_finite()
    }

    /// Returns the deviation of `found` relative to the magnitude; infinity for NaN.
    pub fn deviation(self, found: f64) -> f64 {
        let difference = (found - self.value).abs();
        let relative = difference / self.magnitude;
        if difference == 0.0 {
            0.0
        } else if relative.is_nan() {
            f64::INFINITY
        } else {
            relative
        }
    }

    fn map_value(self, value: f64, slope: f64) -> Self {
        Self::new(value, slope.abs() * self.magnitude)
    }

    fn join_values(self, other: Self, value: f64, slopes: (f64, f64)) -> Self {
        let own = slopes.0.abs() * self.magnitude;
        Self::new(value, own.max(slopes.1.abs() * other.magnitude))
    }

    fn sum_with(self, other: Self) -> Self {
        self.join_values(other, self.value + other.value, (1.0, 1.0))
    }

    fn difference_with(self, other: Self) -> Self {
        self.join_values(other, self.value - other.value, (1.0, 1.0))
    }

    fn product_with(self, other: Self) -> Self {
        let (x, y) = (self.value, other.value);
        self.join_values(other, x * y, (y, x))
    }

    fn quotient_with(self, other: Self) -> Self {
        let (quotient, y) = (self.value / other.value, other.value);
        self.join_values(other, quotient, (y.recip(), quotient / y))
    }

    fn remainder_with(self, other: Self) -> Self {
        let (x, y) = (self.value, other.value);
        self.join_values(other, x % y, (1.0, (x / y).trunc()))
    }
}

macro_rules! operator {
    ($operator:ident, $method:ident, $assign:ident, $assign_method:ident, $own:ident) => {
        impl $operator for Conditioned {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.$own(other)
            }
        }
        impl $operator<&Self> for Conditioned {
            type Output = Self;
            fn $method(self, other: &Self) -> Self {
                self.$own(*other)
            }
        }
        impl $operator<f64> for Conditioned {
            type Output = Self;
            fn $method(self, other: f64) -> Self {
                self.$own(other.into())
            }
        }
        impl $assign for Conditioned {
            fn $assign_method(&mut self, other: Self) {
                *self = self.$own(other);
            }
        }
        impl $assign<f64> for Conditioned {
            fn $assign_method(&mut self, other: f64) {
                *self = self.$own(other.into());
            }
        }
    };
}

operator!(Add, add, AddAssign, add_assign, sum_with);
operator!(Sub, sub, SubAssign, sub_assign, difference_with);
operator!(Mul, mul, MulAssign, mul_assign, product_with);
operator!(Div, div, DivAssign, div_assign, quotient_with);
operator!(Rem, rem, RemAssign, rem_assign, remainder_with);

impl Neg for Conditioned {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            ..self
        }
    }
}

impl From<f64> for Conditioned {
    fn from(value: f64) -> Self {
        Self::new(value, 0.0)
    }
}

impl PartialEq for Conditioned {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl PartialEq<f64> for Conditioned {
    fn eq(&self, other: &f64) -> bool {
        self.value == *other
    }
}

impl PartialOrd for Conditioned {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl PartialOrd<f64> for Conditioned {
    fn partial_cmp(&self, other: &f64) -> Option<Ordering> {
        self.value.partial_cmp(other)
    }
}

impl fmt::Display for Conditioned {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.value.fmt(formatter)
    }
}

impl Zero for Conditioned {
    fn zero() -> Self {
        0.0.into()
    }

    fn is_zero(&self) -> bool {
        self.value == 0.0
    }
}

impl One for Conditioned {
    fn one() -> Self {
        1.0.into()
    }
}

impl Inv for Conditioned {
    type Output = Self;
    fn inv(self) -> Self {
        self.recip()
    }
}

impl Sum for Conditioned {
    fn sum<I: Iterator<Item = Self>>(addends: I) -> Self {
        addends.fold(Self::zero(), Self::sum_with)
    }
}

impl Product for Conditioned {
    fn product<I: Iterator<Item = Self>>(factors: I) -> Self {
        factors.fold(Self::one(), Self::product_with)
    }
}

impl FromPrimitive for Conditioned {
    fn from_i64(number: i64) -> Option<Self> {
        f64::from_i64(number).map(Self::from)
    }

    fn from_u64(number: u64) -> Option<Self> {
        f64::from_u64(number).map(Self::from)
    }

    fn from_f64(number: f64) -> Option<Self> {
        Some(number.into())
    }
}

impl Num for Conditioned {
    type FromStrRadixErr = <f64 as Num>::FromStrRadixErr;

    fn from_str_radix(text: &str, radix: u32) -> Result<Self, Self::FromStrRadixErr> {
        f64::from_str_radix(text, radix).map(Self::from)
    }
}

impl Signed for Conditioned {
    fn abs(&self) -> Self {
        Self {
            value: self.value.abs(),
            ..*self
        }
    }

    fn abs_sub(&self, other: &Self) -> Self {
        if self.value > other.value {
            self.difference_with(*other)
        } else {
            Self::zero()
        }
    }

    fn signum(&self) -> Self {
        self.value.signum().into()
    }

    fn is_positive(&self) -> bool {
        self.value > 0.0
    }

    fn is_negative(&self) -> bool {
        self.value < 0.0
    }
}

impl DualStruct for Conditioned {
    type Real = f64;
    type Inner = f64;

    fn re(&self) -> f64 {
        self.value
    }

    fn from_inner(inner: &f64) -> Self {
        (*inner).into()
    }
}

impl Mappable<Self> for Conditioned {
    type Output<O> = O;

    fn map_dual<M: Fn(Self) -> O, O>(self, map: M) -> O {
        map(self)
    }
}

impl DualNum for Conditioned {
    type Primitive = f64;
    type InnerDual = f64;
    const NDERIV: usize = 0;

    fn from_re(re: f64) -> Self {
        re.into()
    }

    fn scale(self, factor: &f64) -> Self {
        self * *factor
    }

    fn recip(&self) -> Self {
        let value = self.value.recip();
        self.map_value(value, value * value)
    }

    fn powi(&self, n: i32) -> Self {
        let slope = f64::from(n) * self.value.powi(n.saturating_sub(1));
        self.map_value(self.value.powi(n), if n == 0 { 0.0 } else { slope })
    }

    fn powf(&self, n: f64) -> Self {
        let slope = n * self.value.powf(n - 1.0);
        self.map_value(self.value.powf(n), if n == 0.0 { 0.0 } else { slope })
    }

    fn powd(&self, exponent: Self) -> Self {
        let (x, n) = (self.value, exponent.value);
        let value = x.powf(n);
        self.join_values(exponent, value, (n * x.powf(n - 1.0), value * x.ln()))
    }

    fn sqrt(&self) -> Self {
        let value = self.value.sqrt();
        self.map_value(value, 0.5 / value)
    }

    fn cbrt(&self) -> Self {
        let value = self.value.cbrt();
        self.map_value(value, value / (3.0 * self.value))
    }

    fn exp(&self) -> Self {
        let value = self.value.exp();
        self.map_value(value, value)
    }

    fn exp2(&self) -> Self {
        let value = self.value.exp2();
        self.map_value(value, value * std::f64::consts::LN_2)
    }

    fn exp_m1(&self) -> Self {
        self.map_value(self.value.exp_m1(), self.value.exp())
    }

    fn ln(&self) -> Self {
        self.map_value(self.value.ln(), self.value.recip())
    }

    fn log(&self, base: f64) -> Self {
        self.map_value(self.value.log(base), (self.value * base.ln()).recip())
    }

    fn log2(&self) -> Self {
        let slope = (self.value * std::f64::consts::LN_2).recip();
        self.map_value(self.value.log2(), slope)
    }

    fn log10(&self) -> Self {
        let slope = (self.value * std::f64::consts::LN_10).recip();
        self.map_value(self.value.log10(), slope)
    }

    fn ln_1p(&self) -> Self {
        self.map_value(self.value.ln_1p(), (1.0 + self.value).recip())
    }

    fn sin(&self) -> Self {
        self.sin_cos().0
    }

    fn cos(&self) -> Self {
        self.sin_cos().1
    }

    fn tan(&self) -> Self {
        let value = self.value.tan();
        self.map_value(value, 1.0 + value * value)
    }

    fn sin_cos(&self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (self.map_value(sine, cosine), self.map_value(cosine, sine))
    }

    fn asin(&self) -> Self {
        let slope = (1.0 - self.value * self.value).sqrt().recip();
        self.map_value(self.value.asin(), slope)
    }

    fn acos(&self) -> Self {
        let slope = (1.0 - self.value * self.value).sqrt().recip();
        self.map_value(self.value.acos(), slope)
    }

    fn atan(&self) -> Self {
        let slope = (1.0 + self.value * self.value).recip();
        self.map_value(self.value.atan(), slope)
    }

    fn atan2(&self, other: Self) -> Self {
        let (y, x) = (self.value, other.value);
        let square = x * x + y * y;
        self.join_values(other, y.atan2(x), (x / square, y / square))
    }

    fn sinh(&self) -> Self {
        self.map_value(self.value.sinh(), self.value.cosh())
    }

    fn cosh(&self) -> Self {
        self.map_value(self.value.cosh(), self.value.sinh())
    }

    fn tanh(&self) -> Self {
        let value = self.value.tanh();
        self.map_value(value, 1.0 - value * value)
    }

    fn asinh(&self) -> Self {
        let slope = (self.value * self.value + 1.0).sqrt().recip();
        self.map_value(self.value.asinh(), slope)
    }

    fn acosh(&self) -> Self {
        let slope = (self.value * self.value - 1.0).sqrt().recip();
        self.map_value(self.value.acosh(), slope)
    }

    fn atanh(&self) -> Self {
        let slope = (1.0 - self.value * self.value).recip();
        self.map_value(self.value.atanh(), slope)
    }

    fn sph_j0(&self) -> Self {
        if self.value == 0.0 {
            return Self::one();
        }
        self.sin() / *self
    }

    fn sph_j1(&self) -> Self {
        if self.value == 0.0 {
            return *self / 3.0;
        }
        (self.sph_j0() - self.cos()) / *self
    }

    fn sph_j2(&self) -> Self {
        if self.value == 0.0 {
            return *self * *self / 15.0;
        }
        self.sph_j1() * 3.0 / *self - self.sph_j0()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::HyperDual;

    #[test]
    fn magnitude_equals_value_without_cancellation() {
        let (x, y) = (Conditioned::from(0.5), Conditioned::from(0.75));
        for number in [x + y, x * y, y / x, x.exp(), x.powi(3), x.sqrt()] {
            let excess = number.magnitude / number.value;
            assert!((1.0..=3.0).contains(&excess), "{number:?}");
        }
    }

    #[test]
    fn magnitude_of_cancelled_terms_remains() {
        let (large, small) = (Conditioned::from(1e8), Conditioned::from(1.0));
        let rest = (large + small) - large;
        assert_eq!((rest.value, rest.magnitude), (1.0, 1e8 + 1.0));
        assert_eq!((rest * 1e-3).magnitude, (1e8 + 1.0) * 1e-3);
        // The sine of an angle with an error of 1e8 roundings has an error of similar size.
        assert!(rest.sin().magnitude > 0.5e8);
        assert!(rest.exp().magnitude > 1e8);
    }

    #[test]
    fn magnitude_bounds_rounding_of_ill_conditioned_sum() {
        // (1 - cos x)/x^2 for small x, as written and in a stable form.
        for exponent in 1..7 {
            let x = 10.0_f64.powi(-exponent) * 1.2345;
            let number = Conditioned::from(x);
            let written = (Conditioned::one() - number.cos()) / (number * number);
            let stable = 2.0 * ((0.5 * x).sin() / x).powi(2);
            let error = (written.value - stable).abs();
            assert!(error <= 2.0 * f64::EPSILON * written.magnitude, "{x}");
            assert!(written.magnitude < 1e-1 / (x * x) * 20.0);
        }
    }

    #[test]
    fn derivatives_have_magnitudes() {
        // The two terms of d/dx (sin^2 + cos^2) cancel.
        let x = HyperDual::new(0.7.into(), 1.0.into(), 0.0.into(), 0.0.into());
        let sum: HyperDual<Conditioned> = x.sin() * x.sin() + x.cos() * x.cos();
        assert!(sum.eps1.value.abs() < 1e-16);
        assert!(sum.eps1.magnitude > 0.4);
    }

    #[test]
    fn values_equal_plain_f64() {
        let plain = |x: f64| (x.sin() * x + 2.0).ln() / x.powi(3) - x.tanh();
        for x in [0.3, 1.7, 2.9] {
            let number = Conditioned::from(x);
            let found = (number.sin() * number + 2.0).ln() / number.powi(3) - number.tanh();
            assert_eq!(found.value, plain(x));
        }
    }
}
