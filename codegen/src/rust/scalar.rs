//! Emitted trait of numbers with its implementations for `f64` and `f32`. The text is the same in every file,
//! so that a type can implement the trait of every model with the same lines.
//!
//! Elementary functions are called through `Scalar::function`: plain numbers and SIMD lanes compute the
//! kernel, dual numbers its value and slope. Kernels require `Real`, because rounding by addition and
//! exponent fields have no derivatives.

/// Traits of numbers and their implementations.
pub const SCALAR: &str = "\
/// Number type of the equations: `f64`, `f32`, SIMD lanes of them, or dual numbers. The code
/// does not branch on a value, so that lanes can differ in every condition.
pub trait Scalar: Copy
where
    Self: core::ops::Add<Output = Self>,
    Self: core::ops::Sub<Output = Self>,
    Self: core::ops::Mul<Output = Self>,
    Self: core::ops::Div<Output = Self>,
    Self: core::ops::Neg<Output = Self>,
{
    /// Returns a constant, equal in every lane and without derivative.
    fn number(value: f64) -> Self;
    /// Returns `then` if a > b, else `otherwise`, also if either is NaN. The other value has no
    /// effect.
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// Returns true if a > b in every lane.
    fn all_greater(a: Self, b: Self) -> bool;
    /// Applies an elementary function.
    fn function<F: Function>(self) -> Self;
    /// Applies an elementary function of two arguments.
    fn function_of_two<F: FunctionOfTwo>(self, other: Self) -> Self;
    /// Runs a long loop. For single numbers it is not inlined; for lanes it must be, because a
    /// separate function would not be compiled for their registers.
    #[inline(always)]
    fn long_loop<F: FnOnce() -> Self>(lines: F) -> Self {
        lines()
    }
}
/// Number type of the elementary functions: IEEE 754 double precision, SIMD lanes of it, or single
/// precision, with the bits in parentheses.
pub trait Real: Scalar {
    /// Returns `then` if a = b, else `otherwise`, also if either is NaN.
    fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// Clears the sign bit.
    fn magnitude(self) -> Self;
    /// Returns the magnitude with the sign bit of another number.
    fn copy_sign(self, sign: Self) -> Self;
    /// Returns 2^k for an integral k: the addition of 2^52 + 1023 (2^23 + 127) moves k to the
    /// exponent bits.
    fn power_of_two(self) -> Self;
    /// Returns the unbiased exponent field.
    fn exponent(self) -> Self;
    /// Returns the mantissa with the exponent of 1.
    fn significand(self) -> Self;
}
/// Elementary function: plain operations in a fixed order, bit-identical on every machine.
pub trait Function {
    /// Computes the value in double precision.
    fn value<T: Real>(x: T) -> T;
    /// Computes the value in single precision.
    fn single<T: Real>(x: T) -> T;
    /// Computes the derivative at x; `value` is the value at x.
    fn slope<T: Scalar>(x: T, value: T) -> T;
}
/// Elementary function of two arguments.
pub trait FunctionOfTwo {
    /// Computes the value in double precision.
    fn value<T: Real>(x: T, y: T) -> T;
    /// Computes the value in single precision.
    fn single<T: Real>(x: T, y: T) -> T;
    /// Computes the derivatives by x and y; `value` is the value at (x, y).
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
/// Elementary functions are computed in single precision, within two units in the last place:
/// sine, cosine and tangent for |x| up to 1e5.
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
        F::single(self)
    }
    #[inline]
    fn function_of_two<F: FunctionOfTwo>(self, other: f32) -> f32 {
        F::single(self, other)
    }
    #[inline(never)]
    fn long_loop<F: FnOnce() -> f32>(lines: F) -> f32 {
        lines()
    }
}
impl Real for f32 {
    #[inline(always)]
    fn select_equal(a: f32, b: f32, then: f32, otherwise: f32) -> f32 {
        if a == b { then } else { otherwise }
    }
    #[inline(always)]
    fn magnitude(self) -> f32 {
        f32::from_bits(self.to_bits() & !(1 << 31))
    }
    #[inline(always)]
    fn copy_sign(self, sign: f32) -> f32 {
        f32::from_bits((self.to_bits() & !(1 << 31)) | (sign.to_bits() & (1 << 31)))
    }
    #[inline(always)]
    fn power_of_two(self) -> f32 {
        f32::from_bits((self + 8388735.0).to_bits() << 23)
    }
    #[inline(always)]
    fn exponent(self) -> f32 {
        ((self.to_bits() >> 23) & 0xff) as f32 - 127.0
    }
    #[inline(always)]
    fn significand(self) -> f32 {
        f32::from_bits((self.to_bits() & 0x007f_ffff) | 0x3f80_0000)
    }
}
";

/// Trait of coefficients for SIMD lanes.
pub const COEFFICIENT: &str = "\
/// Coefficient of functions for SIMD lanes: a number of their type, or an `f64` that all lanes
/// share, which takes an eighth of the memory.
pub trait Coefficient<T>: Copy {
    /// Returns the number in every lane.
    fn read(self) -> T;
}
impl<T: Scalar> Coefficient<T> for T {
    #[inline(always)]
    fn read(self) -> T {
        self
    }
}
";
