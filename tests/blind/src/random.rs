//! Random numbers of a seed, identical on every computer.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

/// Random number generator.
#[derive(Clone, Debug)]
pub struct RandomStream(ChaCha8Rng);

impl RandomStream {
    /// Starts a stream of random numbers that is independent of other streams.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self(generator)
    }

    /// Draws a uniform number.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * unit
    }

    /// Draws a normal number with mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// Draws a normal number with a magnitude of at most 2.
    pub fn normal_within_two(&mut self) -> f64 {
        loop {
            let value = self.normal();
            if value.abs() <= 2.0 {
                return value;
            }
        }
    }

    /// Draws -1 or 1.
    pub fn sign(&mut self) -> f64 {
        if self.between(0.0, 1.0) < 0.5 {
            -1.0
        } else {
            1.0
        }
    }

    /// Draws an element of a nonempty list.
    pub fn one_of<T: Clone>(&mut self, list: &[T]) -> T {
        list[(self.between(0.0, list.len() as f64) as usize).min(list.len() - 1)].clone()
    }

    /// Shuffles a list.
    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for last in (1..list.len()).rev() {
            let place = self.between(0.0, (last + 1) as f64) as usize;
            list.swap(last, place.min(last));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::RandomStream;

    #[test]
    fn streams_differ_and_repeat() {
        let first = |seed, stream| RandomStream::new(seed, stream).between(0.0, 1.0);
        assert_eq!(first(1, 2), first(1, 2));
        assert_ne!(first(1, 2), first(1, 3));
        assert_ne!(first(1, 2), first(2, 2));
    }

    #[test]
    fn shuffle_keeps_every_element() {
        let mut list: Vec<usize> = (0..50).collect();
        RandomStream::new(3, 0).shuffle(&mut list);
        assert!(list.windows(2).any(|pair| pair[0] > pair[1]));
        list.sort_unstable();
        assert!(list.into_iter().eq(0..50));
    }
}
