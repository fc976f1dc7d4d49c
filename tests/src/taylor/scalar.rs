//! Trait of the integrator's arithmetic, and its implementation for doubles.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Real number of fixed relative precision.
pub trait Scalar:
    Copy
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Send
    + Sync
{
    /// Maximum relative rounding error of one operation.
    const EPSILON: f64;

    /// Degree of the Taylor polynomials. With this degree the remainder is below the rounding error for steps of two to
    /// five radians of the fastest mode.
    const DEGREE: usize;

    /// Pi.
    const PI: Self;

    /// Returns the number with exactly this value.
    fn from_f64(value: f64) -> Self;

    /// Returns the nearest double.
    fn to_f64(self) -> f64;

    /// Returns the product with a double, which needs fewer operations than a product of two numbers of this type.
    fn scaled_by(self, factor: f64) -> Self;

    /// Returns sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);

    /// Returns the exponential.
    fn exp(self) -> Self;

    /// Returns the magnitude.
    fn magnitude(self) -> Self {
        if self < Self::from_f64(0.0) {
            -self
        } else {
            self
        }
    }
}

impl Scalar for f64 {
    const EPSILON: f64 = f64::EPSILON / 2.0;
    const DEGREE: usize = 24;
    const PI: Self = std::f64::consts::PI;

    fn from_f64(value: f64) -> Self {
        value
    }

    fn to_f64(self) -> f64 {
        self
    }

    fn scaled_by(self, factor: f64) -> Self {
        self * factor
    }

    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }

    fn exp(self) -> Self {
        f64::exp(self)
    }
}
