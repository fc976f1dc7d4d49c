//! Hash of bytes with the same value on every computer and in every version.

/// 64-bit FNV-1a hash (G. Fowler, L. Noll and P. Vo).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StableHash(u64);

impl StableHash {
    /// Returns the hash of an empty sequence of bytes.
    pub const fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    /// Returns the hash of the previous bytes followed by these bytes.
    #[must_use]
    pub fn include(self, bytes: &[u8]) -> Self {
        Self(bytes.iter().fold(self.0, |hash, byte| {
            (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
        }))
    }

    /// Returns the value of the hash.
    pub const fn value(self) -> u64 {
        self.0
    }
}

impl Default for StableHash {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::StableHash;

    /// Test values published by the authors.
    #[test]
    fn hashes_have_published_values() {
        for (text, hash) in [
            ("", 0xcbf2_9ce4_8422_2325),
            ("a", 0xaf63_dc4c_8601_ec8c),
            ("foobar", 0x8594_4171_f739_67e8),
        ] {
            assert_eq!(
                StableHash::new().include(text.as_bytes()).value(),
                hash,
                "{text}"
            );
        }
    }
}
