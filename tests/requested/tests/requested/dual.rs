//! Dual numbers with one derivative over any scalar; nested dual numbers have second derivatives. They share no code
//! with the symbolic derivatives except the emitted functions.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Value and derivative.
#[derive(Clone, Copy, Debug)]
pub struct Dual<T> {
    pub value: T,
    pub slope: T,
}

impl<T: Add<Output = T>> Add for Dual<T> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

impl<T: Sub<Output = T>> Sub for Dual<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            slope: self.slope - other.slope,
        }
    }
}

impl<T: Copy + Add<Output = T> + Mul<Output = T>> Mul for Dual<T> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: self.slope * other.value + self.value * other.slope,
        }
    }
}

impl<T: Copy + Sub<Output = T> + Mul<Output = T> + Div<Output = T>> Div for Dual<T> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self {
            value,
            slope: (self.slope - value * other.slope) / other.value,
        }
    }
}

impl<T: Neg<Output = T>> Neg for Dual<T> {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            slope: -self.slope,
        }
    }
}

macro_rules! scalar_of {
    ($($module:ident),*) => {$(
        impl<T: $module::Scalar> $module::Scalar for $crate::dual::Dual<T> {
            fn number(value: f64) -> Self {
                Self { value: T::number(value), slope: T::number(0.0) }
            }
            fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
                Self {
                    value: T::select_greater(a.value, b.value, then.value, otherwise.value),
                    slope: T::select_greater(a.value, b.value, then.slope, otherwise.slope),
                }
            }
            fn all_greater(a: Self, b: Self) -> bool {
                T::all_greater(a.value, b.value)
            }
            fn function<F: $module::Function>(self) -> Self {
                let value = self.value.function::<F>();
                Self { value, slope: F::slope(self.value, value) * self.slope }
            }
            fn function_of_two<F: $module::FunctionOfTwo>(self, other: Self) -> Self {
                let value = self.value.function_of_two::<F>(other.value);
                let [by_first, by_second] = F::slopes(self.value, other.value, value);
                Self { value, slope: by_first * self.slope + by_second * other.slope }
            }
        }
    )*};
}
pub(crate) use scalar_of;
