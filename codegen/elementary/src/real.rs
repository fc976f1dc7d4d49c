//! Primitive operations of the elementary functions, and their implementation for `f64`.
//!
//! Four arithmetic operations, two sign operations, two selections and three operations on the exponent and
//! mantissa fields. Each has one possible result on any IEEE 754 machine, in scalar registers, in SIMD lanes
//! and in software, so that a sequence of them has the same bits everywhere (except for the sign and payload
//! of NaN).
//!
//! Fused multiply-add, square root, rounding and conversion instructions are excluded, because some targets
//! lack them or compute them differently.

use core::ops::{Add, Div, Mul, Neg, Sub};

/// Double-precision number that is computed (`f64`) or recorded (a traced value).
///
/// Arithmetic is IEEE 754 binary64, rounded to nearest even, never contracted.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Returns the literal `value`.
    fn constant(value: f64) -> Self;

    /// Clears the sign bit, also for NaN.
    fn abs(self) -> Self;

    /// Returns the magnitude of `self` with the sign bit of `sign`.
    fn copysign(self, sign: Self) -> Self;

    /// Returns `then` if `left < right`, else `otherwise`, also if either is NaN. Both branches are
    /// evaluated; the unused one has no effect on the result, whatever its value.
    fn select_less(left: Self, right: Self, then: Self, otherwise: Self) -> Self;

    /// Returns `then` if `left == right`, else `otherwise`, also if either is NaN; `-0 == 0`.
    fn select_equal(left: Self, right: Self, then: Self, otherwise: Self) -> Self;

    /// Returns `2^self` for an integral value in `-1022..=1023`, and infinity for `1024`.
    ///
    /// Defined for every argument: add `2^52 + 1023`, shift the bits left by 52. Outside the stated range the
    /// value is meaningless.
    fn power_of_two(self) -> Self;

    /// Returns the unbiased exponent field of a positive normal number `significand * 2^exponent`, as an
    /// integral value. The sign bit is ignored; zero and subnormals give -1023, infinity and NaN 1024.
    fn exponent(self) -> Self;

    /// Returns the mantissa field with the exponent of one: in `[1, 2)` for every argument. The sign bit is
    /// ignored.
    fn significand(self) -> Self;
}

/// `2^52 + 1023`: adding it to an integral `k` leaves `k + 1023` in the low bits of the sum.
const EXPONENT_ALIGNER: f64 = ((1_u64 << 52) + 1023) as f64;
const MANTISSA_BITS: u32 = 52;
const MANTISSA_MASK: u64 = (1 << MANTISSA_BITS) - 1;
const EXPONENT_MASK: u64 = 0x7ff;
const EXPONENT_BIAS: f64 = 1023.0;

impl Real for f64 {
    #[inline(always)]
    fn constant(value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn abs(self) -> f64 {
        f64::from_bits(self.to_bits() & !(1 << 63))
    }

    #[inline(always)]
    fn copysign(self, sign: f64) -> f64 {
        let sign_bit = sign.to_bits() & (1 << 63);
        f64::from_bits((self.to_bits() & !(1 << 63)) | sign_bit)
    }

    #[inline(always)]
    fn select_less(left: f64, right: f64, then: f64, otherwise: f64) -> f64 {
        if left < right { then } else { otherwise }
    }

    #[inline(always)]
    fn select_equal(left: f64, right: f64, then: f64, otherwise: f64) -> f64 {
        if left == right { then } else { otherwise }
    }

    #[inline(always)]
    fn power_of_two(self) -> f64 {
        f64::from_bits((self + EXPONENT_ALIGNER).to_bits() << MANTISSA_BITS)
    }

    #[inline(always)]
    fn exponent(self) -> f64 {
        let field = (self.to_bits() >> MANTISSA_BITS) & EXPONENT_MASK;
        field as f64 - EXPONENT_BIAS
    }

    #[inline(always)]
    fn significand(self) -> f64 {
        f64::from_bits((self.to_bits() & MANTISSA_MASK) | 1.0_f64.to_bits())
    }
}
