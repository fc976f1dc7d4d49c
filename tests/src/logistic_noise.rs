//! Deterministic noise from the centred logistic map.

/// Generator of pseudo-random numbers with mean 0.
pub struct LogisticNoise {
    /// State of the map, between 0 and 1.
    place: f64,
    /// Approximate standard deviation of the numbers.
    size: f64,
}

impl LogisticNoise {
    /// Creates a generator with this standard deviation and initial state (between 0 and 1).
    pub fn new(size: f64, place: f64) -> Self {
        Self { place, size }
    }

    /// Returns the next number.
    pub fn draw(&mut self) -> f64 {
        self.place = 4.0 * self.place * (1.0 - self.place) * 0.999_999;
        self.size * 2.8 * (self.place - 0.5)
    }
}
