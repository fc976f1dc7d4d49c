//! Lanes as the number type of emitted equations.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::vector::{LANES, Vector};

/// Eight numbers in registers `V`.
#[derive(Clone, Copy)]
pub struct Lanes<V>(V);

const SIGN: u64 = 1 << 63;
const ONE: u64 = 0x3ff0_0000_0000_0000;
const MANTISSA: u64 = 0x000f_ffff_ffff_ffff;

/// 2^52. If an integer below 2^52 is added, the last bits of the sum are the bits of the integer.
const INTEGER_ALIGNER: f64 = (1_u64 << 52) as f64;

impl<V: Vector> Lanes<V> {
    /// Sets every lane to the same number.
    #[inline(always)]
    pub fn splat(value: f64) -> Self {
        Self(V::splat(value))
    }

    /// Creates lanes from numbers.
    #[inline(always)]
    pub fn from_array(numbers: [f64; LANES]) -> Self {
        Self(V::from_array(numbers))
    }

    /// Returns the numbers.
    #[inline(always)]
    pub fn to_array(self) -> [f64; LANES] {
        self.0.to_array()
    }

    /// Creates lanes from the numbers of each entry. `array::map` is not used because it is not inlined. It would be
    /// compiled for the baseline instruction set, and this would cost more time than SIMD saves.
    #[inline(always)]
    pub fn from_arrays<const N: usize>(entries: &[[f64; LANES]; N]) -> [Self; N] {
        let mut lanes = [Self::splat(0.0); N];
        for (lanes, numbers) in lanes.iter_mut().zip(entries) {
            *lanes = Self::from_array(*numbers);
        }
        lanes
    }

    /// Returns the numbers of each entry.
    #[inline(always)]
    pub fn to_arrays<const N: usize>(lanes: &[Self; N]) -> [[f64; LANES]; N] {
        let mut entries = [[0.0; LANES]; N];
        for (numbers, lanes) in entries.iter_mut().zip(lanes) {
            *numbers = lanes.to_array();
        }
        entries
    }

    /// Returns `then` in lanes with a > b, else `otherwise`, also if one of them is NaN.
    #[inline(always)]
    pub fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        Self(V::select_greater(a.0, b.0, then.0, otherwise.0))
    }

    /// Returns `then` in lanes with a = b, else `otherwise`, also if one of them is NaN.
    #[inline(always)]
    pub fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        Self(V::select_equal(a.0, b.0, then.0, otherwise.0))
    }

    /// Returns true if a > b in every lane.
    #[inline(always)]
    pub fn all_greater(a: Self, b: Self) -> bool {
        let (a, b) = (a.to_array(), b.to_array());
        a.iter().zip(b).all(|(a, b)| *a > b)
    }

    /// Returns the absolute values.
    #[inline(always)]
    pub fn magnitude(self) -> Self {
        Self(self.0.and(!SIGN))
    }

    /// Returns the absolute values with the signs of `sign`.
    #[inline(always)]
    pub fn copy_sign(self, sign: Self) -> Self {
        Self(self.0.and(!SIGN).or(sign.0.and(SIGN)))
    }

    /// Returns 2^k for integral k from -1022 to 1024, written to the exponent bits.
    #[inline(always)]
    pub fn power_of_two(self) -> Self {
        let aligned = self.0.add(V::splat(INTEGER_ALIGNER + 1023.0));
        Self(aligned.mantissa_to_exponent())
    }

    /// Returns the unbiased exponents as numbers.
    #[inline(always)]
    pub fn exponent(self) -> Self {
        let field = self.0.and(!SIGN).exponent_to_mantissa();
        let aligned = field.or(V::splat(INTEGER_ALIGNER));
        let number = aligned.sub(V::splat(INTEGER_ALIGNER));
        Self(number.sub(V::splat(1023.0)))
    }

    /// Returns the significands, scaled to [1, 2).
    #[inline(always)]
    pub fn significand(self) -> Self {
        Self(self.0.and(MANTISSA).or(V::splat(f64::from_bits(ONE))))
    }
}

impl<V: Vector> Add for Lanes<V> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0.add(other.0))
    }
}

impl<V: Vector> Sub for Lanes<V> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0.sub(other.0))
    }
}

impl<V: Vector> Mul for Lanes<V> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0.mul(other.0))
    }
}

impl<V: Vector> Div for Lanes<V> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self(self.0.div(other.0))
    }
}

impl<V: Vector> Neg for Lanes<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.flip(SIGN))
    }
}

/// Implements the trait `Scalar` of an emitted module for [`Lanes`]. The module must be in the calling crate.
#[macro_export]
macro_rules! scalar {
    ($($module:ident)::+) => {
        impl<V: $crate::Vector> $($module)::+::Scalar for $crate::Lanes<V> {
            #[inline(always)]
            fn number(value: f64) -> Self {
                Self::splat(value)
            }
            #[inline(always)]
            fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
                Self::select_greater(a, b, then, otherwise)
            }
            #[inline(always)]
            fn all_greater(a: Self, b: Self) -> bool {
                Self::all_greater(a, b)
            }
            #[inline(always)]
            fn function<F: $($module)::+::Function>(self) -> Self {
                F::value(self)
            }
            #[inline(always)]
            fn function_of_two<F: $($module)::+::FunctionOfTwo>(self, other: Self) -> Self {
                F::value(self, other)
            }
        }
        impl<V: $crate::Vector> $($module)::+::Coefficient<$crate::Lanes<V>> for f64 {
            #[inline(always)]
            fn read(self) -> $crate::Lanes<V> {
                $crate::Lanes::splat(self)
            }
        }
        impl<V: $crate::Vector> $($module)::+::Real for $crate::Lanes<V> {
            #[inline(always)]
            fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
                Self::select_equal(a, b, then, otherwise)
            }
            #[inline(always)]
            fn magnitude(self) -> Self {
                self.magnitude()
            }
            #[inline(always)]
            fn copy_sign(self, sign: Self) -> Self {
                self.copy_sign(sign)
            }
            #[inline(always)]
            fn power_of_two(self) -> Self {
                self.power_of_two()
            }
            #[inline(always)]
            fn exponent(self) -> Self {
                self.exponent()
            }
            #[inline(always)]
            fn significand(self) -> Self {
                self.significand()
            }
        }
    };
}
