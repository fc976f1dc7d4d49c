//! Closed interval of admissible values.

/// Closed interval from `low` to `high`. An end may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// All real numbers.
    pub const ALL: Self = Self::new(f64::NEG_INFINITY, f64::INFINITY);
    /// Interval that contains only 0.
    pub const ZERO: Self = Self::new(0.0, 0.0);

    /// Creates the interval from `low` to `high`.
    pub const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Returns true if both ends are equal.
    pub fn is_point(self) -> bool {
        self.low == self.high
    }

    /// Returns true if `value` is in the interval.
    pub fn contains(self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// Returns the nearest value in the interval.
    pub fn clamp(self, value: f64) -> f64 {
        value.clamp(self.low, self.high)
    }

    /// Returns the intersection of two intervals.
    pub fn intersect(self, other: Self) -> Self {
        Self::new(self.low.max(other.low), self.high.min(other.high))
    }

    /// Returns the smallest interval that contains both.
    pub fn join(self, other: Self) -> Self {
        Self::new(self.low.min(other.low), self.high.max(other.high))
    }

    /// Subtracts `origin` from both ends.
    pub fn shift_origin_to(self, origin: f64) -> Self {
        Self::new(self.low - origin, self.high - origin)
    }

    /// Returns the smallest interval that also contains 0.
    pub fn extend_to_zero(self) -> Self {
        self.join(Self::ZERO)
    }

    /// Multiplies both ends by a positive factor.
    pub fn scale(self, factor: f64) -> Self {
        Self::new(factor * self.low, factor * self.high)
    }
}
