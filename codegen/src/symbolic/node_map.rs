//! Maps by nodes and operations. A derivation looks up millions of entries, and no attacker chooses them: a few
//! operations per word suffice (FxHash of Firefox and rustc).

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// A map by nodes or operations.
pub(crate) type NodeMap<K, V> = HashMap<K, V, BuildHasherDefault<WordHasher>>;

/// A polynomial hash of words.
#[derive(Clone, Default)]
pub(crate) struct WordHasher {
    state: u64,
}

/// An odd number without a pattern in its bits.
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
        // The high bits of a product depend on all of its factors' bits; tables look at the low ones.
        self.state.rotate_left(26)
    }
}
