//! Number types in which the steps of a program can be computed.

use eomgen_elementary::{Function as Elementary, Real};
use eomgen_model_spec::function::Function;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use super::functions::call;

/// Number type of the evaluator: `f64`, `f32` (bit-identical to emitted code in single precision), or a number that
/// records the operations.
pub trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// Returns the constant `value`, rounded to the format.
    fn constant(value: f64) -> Self;

    /// Computes a function of the expression language; functions of one argument ignore `b`.
    fn call(function: Function, a: Self, b: Self) -> Self;

    /// Returns a^b.
    fn power(self, exponent: Self) -> Self;

    /// Returns `then` if a > b, else `otherwise`; returns `otherwise` if a or b is NaN.
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self;

    /// Returns the number if it is positive, else NaN.
    fn positive(self) -> Self;
}

macro_rules! implement_number {
    ($number:ty) => {
        impl Number for $number {
            #[inline(always)]
            fn constant(value: f64) -> Self {
                <Self as Real>::constant(value)
            }

            #[inline(always)]
            fn call(function: Function, a: Self, b: Self) -> Self {
                call(function, a, b)
            }

            #[inline(always)]
            fn power(self, exponent: Self) -> Self {
                Elementary::Pow.apply(&[self, exponent])
            }

            #[inline(always)]
            fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
                if a > b { then } else { otherwise }
            }

            #[inline(always)]
            fn positive(self) -> Self {
                if self > 0.0 { self } else { Self::NAN }
            }
        }
    };
}

implement_number!(f64);
implement_number!(f32);
