//! Primitive operations of the elementary functions, and their implementation for `f64`.
//!
//! There are four arithmetic operations, two sign operations, two selections and three operations on the exponent and
//! mantissa fields. IEEE 754 defines the result of each, in scalar registers, in SIMD lanes and in software. A
//! sequence of these operations is therefore bit-identical on every machine, except for the sign and payload of NaN.
//!
//! Fused multiply-add, square root, rounding and conversion instructions are excluded, because some targets
//! lack them or compute them differently.

use crate::precision::{Double, Precision, Single};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Number type: computes values (`f64`, `f32`) or records operations (`Traced`).
///
/// Arithmetic follows IEEE 754 in the format of the type. It is rounded to nearest, ties to even, and never
/// contracted.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Format of the numbers.
    type Precision: Precision;

    /// Returns the literal `value`, rounded to the format.
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

    /// Returns `2^self` for an integral value in `-1022..=1023` (`-126..=127` in single precision), and infinity for
    /// `1024` (`128`).
    ///
    /// Defined for every argument: add `2^52 + 1023` (`2^23 + 127`), shift the bits left by 52 (23). Outside the
    /// stated range the value is meaningless.
    fn power_of_two(self) -> Self;

    /// Returns the unbiased exponent field of a positive normal number `significand * 2^exponent`, as an
    /// integral value. The sign bit is ignored; zero and subnormals give -1023 (-127), infinity and NaN 1024
    /// (128).
    fn exponent(self) -> Self;

    /// Returns the mantissa field with the exponent of one: in `[1, 2)` for every argument. The sign bit is
    /// ignored.
    fn significand(self) -> Self;
}

/// Constants of the format of `R`.
pub(crate) type Format<R> = <R as Real>::Precision;

macro_rules! implement_real {
    ($number:ty, $precision:ty, $mantissa_bits:literal, $sign:expr, $exponent_mask:literal, $bias:literal) => {
        impl Real for $number {
            type Precision = $precision;

            #[inline(always)]
            fn constant(value: f64) -> $number {
                value as $number
            }

            #[inline(always)]
            fn abs(self) -> $number {
                <$number>::from_bits(self.to_bits() & !$sign)
            }

            #[inline(always)]
            fn copysign(self, sign: $number) -> $number {
                <$number>::from_bits((self.to_bits() & !$sign) | (sign.to_bits() & $sign))
            }

            #[inline(always)]
            fn select_less(
                left: $number,
                right: $number,
                then: $number,
                otherwise: $number,
            ) -> $number {
                if left < right { then } else { otherwise }
            }

            #[inline(always)]
            fn select_equal(
                left: $number,
                right: $number,
                then: $number,
                otherwise: $number,
            ) -> $number {
                if left == right { then } else { otherwise }
            }

            // The low bits of the sum are k + bias.
            #[inline(always)]
            fn power_of_two(self) -> $number {
                let aligner = (1_u64 << $mantissa_bits) as $number + $bias;
                <$number>::from_bits((self + aligner).to_bits() << $mantissa_bits)
            }

            #[inline(always)]
            fn exponent(self) -> $number {
                let field = (self.to_bits() >> $mantissa_bits) & $exponent_mask;
                field as $number - $bias
            }

            #[inline(always)]
            fn significand(self) -> $number {
                let mantissa = self.to_bits() & ((1 << $mantissa_bits) - 1);
                <$number>::from_bits(mantissa | <$number>::to_bits(1.0))
            }
        }
    };
}

implement_real!(f64, Double, 52, 1_u64 << 63, 0x7ff, 1023.0);
implement_real!(f32, Single, 23, 1_u32 << 31, 0xff, 127.0);
