//! Pseudo-random numbers: SplitMix64 (Steele, Lea and Flood 2014), the same on every machine.

use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// Deterministic pseudo-random sequence.
#[derive(Clone, Debug)]
pub struct Random(SplitMix64);

impl Random {
    /// Creates the sequence with the seed `seed`.
    pub fn new(seed: u64) -> Self {
        Self(SplitMix64::seed_from_u64(seed))
    }

    /// Returns a random number, uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (0.5_f64).powi(53)
    }

    /// Returns a random number, uniform in [-1, 1).
    pub fn symmetric(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// Returns a random number with either sign and a magnitude that is uniform in [1/4, 1).
    pub fn away_from_zero(&mut self) -> f64 {
        let signed = self.symmetric();
        signed.signum() * (0.25 + 0.75 * signed.abs())
    }

    /// Returns a random element of `choices`; `None` if it is empty.
    pub fn pick<'c, T>(&mut self, choices: &'c [T]) -> Option<&'c T> {
        choices.get((self.unit() * choices.len() as f64) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_number_matches_published_value() {
        assert_eq!(
            Random::new(1_234_567).0.next_u64(),
            6_457_827_717_110_365_317
        );
    }

    #[test]
    fn mean_of_symmetric_numbers_is_zero() {
        let mut random = Random::new(1);
        let sum: f64 = (0..10_000).map(|_| random.symmetric()).sum();
        // Standard deviation of the mean: 1/sqrt(3 * 10^4) = 6e-3.
        assert!((sum / 1e4).abs() < 0.03);
    }
}
