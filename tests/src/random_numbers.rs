//! Pseudo-random numbers of the tests, identical on every platform.

/// Xorshift generator; its state must not be 0.
pub struct Numbers(pub u64);

impl Numbers {
    /// Returns the next number, between -1 and 1.
    pub fn symmetric(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
    }
}

/// Normal numbers (Box and Muller 1958) from a multiplicative generator (Park and Miller 1988).
pub struct NormalNumbers(u64);

impl NormalNumbers {
    /// Creates a generator with a seed other than 0. The first numbers are skipped, because they are similar for
    /// similar seeds.
    pub fn new(seed: u64) -> Self {
        let mut numbers = Self(seed);
        for _ in 0..20 {
            numbers.uniform();
        }
        numbers
    }

    fn uniform(&mut self) -> f64 {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        self.0 as f64 / 2_147_483_647.0
    }

    /// Returns the next normal number, with mean 0 and variance 1.
    pub fn draw(&mut self) -> f64 {
        let (a, b) = (self.uniform(), self.uniform());
        (-2.0 * a.ln()).sqrt() * (2.0 * std::f64::consts::PI * b).cos()
    }
}
