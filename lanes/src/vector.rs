//! Operations on registers of eight numbers, and their implementation with plain numbers.

/// Number of lanes.
pub const LANES: usize = 8;

/// Restricts [`Vector`] to this crate, so that a [`crate::Task`] never runs with registers that the machine lacks.
pub trait Sealed {}

/// Eight numbers. The result of every operation is bit-identical in each lane to that of `f64`.
pub trait Vector: Sealed + Copy {
    /// Sets every lane to the same number.
    fn splat(value: f64) -> Self;
    /// Creates a vector from numbers.
    fn from_array(numbers: [f64; LANES]) -> Self;
    /// Returns the numbers.
    fn to_array(self) -> [f64; LANES];
    /// Returns a + b.
    fn add(self, other: Self) -> Self;
    /// Returns a - b.
    fn sub(self, other: Self) -> Self;
    /// Returns a b.
    fn mul(self, other: Self) -> Self;
    /// Returns a / b.
    fn div(self, other: Self) -> Self;
    /// Returns `then` in lanes with a > b, else `otherwise`.
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// Returns `then` in lanes with a = b, else `otherwise`.
    fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// Returns the bitwise AND with `bits`.
    fn and(self, bits: u64) -> Self;
    /// Returns the bitwise OR.
    fn or(self, other: Self) -> Self;
    /// Returns the bitwise exclusive OR with `bits`.
    fn flip(self, bits: u64) -> Self;
    /// Shifts the bits left by the width of the mantissa.
    fn mantissa_to_exponent(self) -> Self;
    /// Shifts the bits right by the width of the mantissa.
    fn exponent_to_mantissa(self) -> Self;
}

/// Width of the mantissa, in bits.
pub const MANTISSA_BITS: u32 = 52;

/// Eight plain numbers, for every machine.
#[derive(Clone, Copy)]
pub struct Plain([f64; LANES]);

impl Plain {
    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(function))
    }

    #[inline(always)]
    fn zip(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| function(self.0[i], other.0[i])))
    }

    #[inline(always)]
    fn select(then: Self, otherwise: Self, chosen: impl Fn(usize) -> bool) -> Self {
        let number = |i: usize| if chosen(i) { then.0[i] } else { otherwise.0[i] };
        Self(std::array::from_fn(number))
    }

    #[inline(always)]
    fn map_bits(self, function: impl Fn(u64) -> u64) -> Self {
        self.map(|x| f64::from_bits(function(x.to_bits())))
    }
}

impl Sealed for Plain {}

impl Vector for Plain {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; LANES])
    }
    #[inline(always)]
    fn from_array(numbers: [f64; LANES]) -> Self {
        Self(numbers)
    }
    #[inline(always)]
    fn to_array(self) -> [f64; LANES] {
        self.0
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
    #[inline(always)]
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        Self::select(then, otherwise, |i| a.0[i] > b.0[i])
    }
    #[inline(always)]
    fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        Self::select(then, otherwise, |i| a.0[i] == b.0[i])
    }
    #[inline(always)]
    fn and(self, bits: u64) -> Self {
        self.map_bits(|x| x & bits)
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self.zip(other, |a, b| f64::from_bits(a.to_bits() | b.to_bits()))
    }
    #[inline(always)]
    fn flip(self, bits: u64) -> Self {
        self.map_bits(|x| x ^ bits)
    }
    #[inline(always)]
    fn mantissa_to_exponent(self) -> Self {
        self.map_bits(|x| x << MANTISSA_BITS)
    }
    #[inline(always)]
    fn exponent_to_mantissa(self) -> Self {
        self.map_bits(|x| x >> MANTISSA_BITS)
    }
}
