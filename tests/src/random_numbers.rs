//! Random numbers of the tests, the same on every machine.

/// Xorshift generator; its state is not 0.
pub struct Numbers(pub u64);

impl Numbers {
    /// Returns the next number between -1 and 1.
    pub fn symmetric(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
    }
}
