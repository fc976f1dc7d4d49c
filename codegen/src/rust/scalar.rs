//! Emitted trait of numbers with its implementations for `f64` and `f32`. The text is the same in every file,
//! so that a type can implement the trait of every model with the same lines.
//!
//! Elementary functions are called through `Scalar::function`: plain numbers and SIMD lanes compute the
//! kernel, dual numbers its value and slope. Kernels require `Real`, because rounding by addition and
//! exponent fields have no derivatives.

/// Traits of numbers and their implementations.
pub const SCALAR: &str = "\
/// What the equations are computed with: `f64`, `f32`, lanes of them, or numbers that carry
/// derivatives. Nothing branches on a value, so that lanes may differ in every condition.
pub trait Scalar: Copy
where
    Self: core::ops::Add<Output = Self>,
    Self: core::ops::Sub<Output = Self>,
    Self: core::ops::Mul<Output = Self>,
    Self: core::ops::Div<Output = Self>,
    Self: core::ops::Neg<Output = Self>,
{
    /// A number, in every lane and without derivative.
    fn number(value: f64) -> Self;
    /// `then` where a > b, `otherwise` elsewhere, also where either is NaN. Whatever is not
    /// chosen leaves no trace.
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// Whether a > b in every lane.
    fn all_greater(a: Self, b: Self) -> bool;
    /// An elementary function of this.
    fn function<F: Function>(self) -> Self;
    /// An elementary function of this and another.
    fn function_of_two<F: FunctionOfTwo>(self, other: Self) -> Self;
    /// A long loop. Single numbers keep it out of the code around; lanes must not, because code
    /// of its own would not be compiled for their registers.
    #[inline(always)]
    fn long_loop<F: FnOnce() -> Self>(lines: F) -> Self {
        lines()
    }
}
/// Numbers in IEEE 754 double precision, or lanes of them: what the elementary functions are
/// written for.
pub trait Real: Scalar {
    /// `then` where a = b, `otherwise` elsewhere, also where either is NaN.
    fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// The sign bit cleared.
    fn magnitude(self) -> Self;
    /// The magnitude with the sign bit of another number.
    fn copy_sign(self, sign: Self) -> Self;
    /// 2^k for an integral k: 2^52 + 1023 brings it to the place of the exponent.
    fn power_of_two(self) -> Self;
    /// The unbiased exponent field.
    fn exponent(self) -> Self;
    /// The mantissa under the exponent of 1.
    fn significand(self) -> Self;
}
/// An elementary function: plain operations in a fixed order, the same bits on every machine.
pub trait Function {
    /// Its value.
    fn value<T: Real>(x: T) -> T;
    /// Its derivative at x, where it is `value`.
    fn slope<T: Scalar>(x: T, value: T) -> T;
}
/// An elementary function of two arguments.
pub trait FunctionOfTwo {
    /// Its value.
    fn value<T: Real>(x: T, y: T) -> T;
    /// Its derivatives by x and y, where it is `value`.
    fn slopes<T: Scalar>(x: T, y: T, value: T) -> [T; 2];
}
impl Scalar for f64 {
    #[inline(always)]
    fn number(value: f64) -> f64 {
        value
    }
    #[inline(always)]
    fn select_greater(a: f64, b: f64, then: f64, otherwise: f64) -> f64 {
        if a > b { then } else { otherwise }
    }
    #[inline(always)]
    fn all_greater(a: f64, b: f64) -> bool {
        a > b
    }
    #[inline]
    fn function<F: Function>(self) -> f64 {
        F::value(self)
    }
    #[inline]
    fn function_of_two<F: FunctionOfTwo>(self, other: f64) -> f64 {
        F::value(self, other)
    }
    #[inline(never)]
    fn long_loop<F: FnOnce() -> f64>(lines: F) -> f64 {
        lines()
    }
}
impl Real for f64 {
    #[inline(always)]
    fn select_equal(a: f64, b: f64, then: f64, otherwise: f64) -> f64 {
        if a == b { then } else { otherwise }
    }
    #[inline(always)]
    fn magnitude(self) -> f64 {
        f64::from_bits(self.to_bits() & !(1 << 63))
    }
    #[inline(always)]
    fn copy_sign(self, sign: f64) -> f64 {
        f64::from_bits((self.to_bits() & !(1 << 63)) | (sign.to_bits() & (1 << 63)))
    }
    #[inline(always)]
    fn power_of_two(self) -> f64 {
        f64::from_bits((self + 4503599627371519.0).to_bits() << 52)
    }
    #[inline(always)]
    fn exponent(self) -> f64 {
        ((self.to_bits() >> 52) & 0x7ff) as f64 - 1023.0
    }
    #[inline(always)]
    fn significand(self) -> f64 {
        f64::from_bits((self.to_bits() & 0x000f_ffff_ffff_ffff) | 0x3ff0_0000_0000_0000)
    }
}
/// Elementary functions in double precision, then rounded: within 0.5001 units in the last
/// place.
impl Scalar for f32 {
    #[inline(always)]
    fn number(value: f64) -> f32 {
        value as f32
    }
    #[inline(always)]
    fn select_greater(a: f32, b: f32, then: f32, otherwise: f32) -> f32 {
        if a > b { then } else { otherwise }
    }
    #[inline(always)]
    fn all_greater(a: f32, b: f32) -> bool {
        a > b
    }
    #[inline]
    fn function<F: Function>(self) -> f32 {
        F::value(f64::from(self)) as f32
    }
    #[inline]
    fn function_of_two<F: FunctionOfTwo>(self, other: f32) -> f32 {
        F::value(f64::from(self), f64::from(other)) as f32
    }
    #[inline(never)]
    fn long_loop<F: FnOnce() -> f32>(lines: F) -> f32 {
        lines()
    }
}
";

/// Trait of coefficients for SIMD lanes.
pub const COEFFICIENT: &str = "\
/// A coefficient as the functions for lanes read it: a number of the type that they compute
/// with, or an `f64` that all lanes share, which takes an eighth of the memory.
pub trait Coefficient<T>: Copy {
    /// The number, in every lane.
    fn read(self) -> T;
}
impl<T: Scalar> Coefficient<T> for T {
    #[inline(always)]
    fn read(self) -> T {
        self
    }
}
";
