//! Hash maps with nodes or operations as keys. A derivation performs millions of lookups, and the keys are trusted.
//! Therefore a fast hash without protection against collisions suffices (FxHash of Firefox and rustc).

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

pub(crate) type NodeMap<K, V> = HashMap<K, V, BuildHasherDefault<WordHasher>>;

/// Polynomial hash of words.
#[derive(Clone, Default)]
pub(crate) struct WordHasher {
    state: u64,
}

/// Odd multiplier with irregular bits.
const MULTIPLIER: u64 = 0xf135_7aea_2e62_a9c5;

impl Hasher for WordHasher {
    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.write_u64(u64::from_le_bytes(word));
        }
    }

    fn write_u8(&mut self, number: u8) {
        self.write_u64(u64::from(number));
    }

    fn write_u32(&mut self, number: u32) {
        self.write_u64(u64::from(number));
    }

    fn write_u64(&mut self, number: u64) {
        self.state = self.state.wrapping_add(number).wrapping_mul(MULTIPLIER);
    }

    fn write_usize(&mut self, number: usize) {
        self.write_u64(number as u64);
    }

    fn finish(&self) -> u64 {
        // The high bits of a product depend on all bits of its factors, but hash tables use the low bits.
        self.state.rotate_left(26)
    }
}
