//! A noise that is the same everywhere: the logistic map, centred.

/// Numbers of mean 0, one after the other.
pub struct LogisticNoise {
    /// Where the map stands, between 0 and 1.
    place: f64,
    /// One standard deviation of the numbers, nearly.
    size: f64,
}

impl LogisticNoise {
    /// Of this size, from a place between 0 and 1, which makes it another one.
    pub fn new(size: f64, place: f64) -> Self {
        Self { place, size }
    }

    /// The next number.
    pub fn draw(&mut self) -> f64 {
        self.place = 4.0 * self.place * (1.0 - self.place) * 0.999_999;
        self.size * 2.8 * (self.place - 0.5)
    }
}
