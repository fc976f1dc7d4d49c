//! Maps with nodes or operations as keys. A derivation performs millions of lookups with trusted keys, so
//! that a few operations per word suffice as hash (FxHash of Firefox and rustc).

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

pub(crate) type NodeMap<K, V> = HashMap<K, V, BuildHasherDefault<WordHasher>>;

/// Polynomial hash of words.
#[derive(Clone, Default)]
pub(crate) struct WordHasher {
    state: u64,
}

/// Odd number without a bit pattern.
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
        // The high bits of a product depend on all bits of its factors; hash tables use the low ones.
        self.state.rotate_left(26)
    }
}
