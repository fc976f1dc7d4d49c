//! Numbers that bound their own rounding error (running error analysis: N. J. Higham,
//! Accuracy and Stability of Numerical Algorithms, section 3.3). Under duals they say how far a
//! derivative can be trusted where its terms cancel.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number and a bound of its error.
#[derive(Clone, Copy, Debug)]
pub struct Tracked {
    /// The number.
    pub number: f64,
    /// A bound of the error that rounding left in it.
    pub error: f64,
}

/// Half a unit in the last place of 1.
const UNIT: f64 = f64::EPSILON / 2.0;

impl Tracked {
    /// A number without error.
    pub fn exact(number: f64) -> Self {
        Self { number, error: 0.0 }
    }

    /// A result whose operands left it this error.
    pub fn rounded(number: f64, error: f64) -> Self {
        Self {
            number,
            error: error + UNIT * number.abs(),
        }
    }
}

impl Add for Tracked {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::rounded(self.number + other.number, self.error + other.error)
    }
}

impl Sub for Tracked {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::rounded(self.number - other.number, self.error + other.error)
    }
}

impl Mul for Tracked {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let error = self.number.abs() * other.error + other.number.abs() * self.error;
        Self::rounded(self.number * other.number, error)
    }
}

impl Div for Tracked {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let quotient = self.number / other.number;
        let error = (self.error + quotient.abs() * other.error) / other.number.abs();
        Self::rounded(quotient, error)
    }
}

impl Neg for Tracked {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            number: -self.number,
            error: self.error,
        }
    }
}

/// Makes them a scalar of an emitted module. Elementary functions are right to two units.
macro_rules! tracked_scalar_of {
    ($($module:ident),*) => {$(
        impl $module::Scalar for $crate::tracked::Tracked {
            fn number(value: f64) -> Self {
                Self::exact(value)
            }
            fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
                if a.number > b.number { then } else { otherwise }
            }
            fn all_greater(a: Self, b: Self) -> bool {
                a.number > b.number
            }
            fn function<F: $module::Function>(self) -> Self {
                let value = F::value(self.number);
                let slope = F::slope(self.number, value);
                Self::rounded(value, slope.abs() * self.error + f64::EPSILON * value.abs())
            }
            fn function_of_two<F: $module::FunctionOfTwo>(self, other: Self) -> Self {
                let value = F::value(self.number, other.number);
                let [first, second] = F::slopes(self.number, other.number, value);
                let error = first.abs() * self.error + second.abs() * other.error;
                Self::rounded(value, error + f64::EPSILON * value.abs())
            }
        }
    )*};
}
pub(crate) use tracked_scalar_of;
