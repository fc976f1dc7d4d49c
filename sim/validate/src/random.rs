//! The pseudo-random numbers of the validation: SplitMix64, so that a certificate is the
//! same on every machine. For tests of equations, not for statistics or secrets.

/// A deterministic sequence.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// The sequence of `seed`.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The next 64 bits (Steele, Lea and Flood 2014).
    fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (0.5_f64).powi(53)
    }

    /// Uniform in [-1, 1).
    pub fn symmetric(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// Either sign, the magnitude uniform in [1/4, 1).
    pub fn away_from_zero(&mut self) -> f64 {
        let signed = self.symmetric();
        signed.signum() * (0.25 + 0.75 * signed.abs())
    }

    /// One of `choices`, none if there is none.
    pub fn pick<'c, T>(&mut self, choices: &'c [T]) -> Option<&'c T> {
        choices.get((self.unit() * choices.len() as f64) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_number_is_the_published_one() {
        assert_eq!(Random::new(1_234_567).bits(), 6_457_827_717_110_365_317);
    }

    #[test]
    fn the_mean_is_in_the_middle() {
        let mut random = Random::new(1);
        let sum: f64 = (0..10_000).map(|_| random.symmetric()).sum();
        // Standard deviation of the mean: 1/sqrt(3 * 10^4) = 6e-3.
        assert!((sum / 1e4).abs() < 0.03);
    }
}
