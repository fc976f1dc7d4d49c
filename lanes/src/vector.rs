//! What registers of eight numbers do, and the eight plain numbers that do it anywhere.

/// How many numbers.
pub const LANES: usize = 8;

/// Only this crate's registers are vectors: a [`crate::Task`] is given none that the machine
/// lacks.
pub trait Sealed {}

/// Eight numbers. Every operation is that of `f64` in each lane, with its very bits.
pub trait Vector: Sealed + Copy {
    /// The same number in every lane.
    fn splat(value: f64) -> Self;
    /// These numbers.
    fn from_array(numbers: [f64; LANES]) -> Self;
    /// The numbers.
    fn to_array(self) -> [f64; LANES];
    /// a + b
    fn add(self, other: Self) -> Self;
    /// a - b
    fn sub(self, other: Self) -> Self;
    /// a b
    fn mul(self, other: Self) -> Self;
    /// a / b
    fn div(self, other: Self) -> Self;
    /// `then` where a > b, else `otherwise`.
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// `then` where a = b, else `otherwise`.
    fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// The bits of these numbers and of others where both have them.
    fn and(self, bits: u64) -> Self;
    /// The bits of these numbers and those of others.
    fn or(self, other: Self) -> Self;
    /// The bits of these numbers where these are not set.
    fn flip(self, bits: u64) -> Self;
    /// The bits moved up by the width of the mantissa.
    fn mantissa_to_exponent(self) -> Self;
    /// The bits moved down by the width of the mantissa.
    fn exponent_to_mantissa(self) -> Self;
}

/// The width of the mantissa.
pub const MANTISSA_BITS: u32 = 52;

/// Eight plain numbers, for machines of any kind.
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
