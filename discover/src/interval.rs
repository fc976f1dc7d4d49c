//! A closed interval of admissible values.

/// All values from `low` to `high`, both included; an end may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The smallest.
    pub low: f64,
    /// The largest.
    pub high: f64,
}

impl Interval {
    /// Every number.
    pub const ALL: Self = Self::new(f64::NEG_INFINITY, f64::INFINITY);
    /// Zero alone.
    pub const ZERO: Self = Self::new(0.0, 0.0);

    /// From `low` to `high`.
    pub const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Whether it is one value.
    pub fn is_point(self) -> bool {
        self.low == self.high
    }

    /// Returns true if it holds a value.
    pub fn contains(self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// The value in it that is nearest to `value`.
    pub fn clamp(self, value: f64) -> f64 {
        value.clamp(self.low, self.high)
    }

    /// What both hold.
    pub fn intersection(self, other: Self) -> Self {
        Self::new(self.low.max(other.low), self.high.min(other.high))
    }

    /// The smallest interval that holds both.
    pub fn hull(self, other: Self) -> Self {
        Self::new(self.low.min(other.low), self.high.max(other.high))
    }

    /// The same, seen from `origin`.
    pub fn relative_to(self, origin: f64) -> Self {
        Self::new(self.low - origin, self.high - origin)
    }

    /// Widened until it holds 0.
    pub fn with_zero(self) -> Self {
        self.hull(Self::ZERO)
    }

    /// Both ends times a positive number.
    pub fn times(self, factor: f64) -> Self {
        Self::new(factor * self.low, factor * self.high)
    }
}
