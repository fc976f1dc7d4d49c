//! Numbers with a bound of their rounding error, computed in double precision (running error analysis: N. J. Higham,
//! Accuracy and Stability of Numerical Algorithms, section 3.3).

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Number with a bound of its error for arithmetic of `DIGITS` binary digits.
#[derive(Clone, Copy, Debug)]
pub struct Rounded<const DIGITS: u32> {
    pub number: f64,
    /// Bound of the accumulated rounding error.
    pub error: f64,
}

impl<const DIGITS: u32> Rounded<DIGITS> {
    /// Unit roundoff for `DIGITS` binary digits.
    const UNIT: f64 = 1.0 / (1_u64 << DIGITS) as f64;

    pub fn exact(number: impl Into<f64>) -> Self {
        Self {
            number: number.into(),
            error: 0.0,
        }
    }

    /// Returns a result; its error is the propagated error plus the rounding error of the operation.
    pub fn with_rounding(number: f64, error: f64) -> Self {
        Self {
            number,
            error: error + Self::UNIT * number.abs(),
        }
    }
}

impl<const DIGITS: u32> Add for Rounded<DIGITS> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::with_rounding(self.number + other.number, self.error + other.error)
    }
}

impl<const DIGITS: u32> Sub for Rounded<DIGITS> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::with_rounding(self.number - other.number, self.error + other.error)
    }
}

impl<const DIGITS: u32> Mul for Rounded<DIGITS> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let error = self.number.abs() * other.error + other.number.abs() * self.error;
        Self::with_rounding(self.number * other.number, error)
    }
}

impl<const DIGITS: u32> Div for Rounded<DIGITS> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let quotient = self.number / other.number;
        let error = (self.error + quotient.abs() * other.error) / other.number.abs();
        Self::with_rounding(quotient, error)
    }
}

impl<const DIGITS: u32> Neg for Rounded<DIGITS> {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            number: -self.number,
            error: self.error,
        }
    }
}
