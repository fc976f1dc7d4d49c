//! Selection of a sweep's chunks for one run.

use super::error::SweepError;

/// Part `number` of `count`, from 1. Chunks are assigned in turn, so that all shards get a share of slow regions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: usize,
    count: usize,
}

impl Shard {
    /// Shard with all chunks.
    pub const WHOLE: Self = Self {
        number: 1,
        count: 1,
    };

    /// Parses a shard, for example `2/3`.
    ///
    /// # Errors
    /// Another form, or a number outside 1 to the count.
    pub fn parse(text: &str) -> Result<Self, SweepError> {
        let refused = |reason: &str| {
            Err(SweepError::Request(format!(
                "--shard {text}: {reason}, such as 2/3 for the second of three"
            )))
        };
        let numbers = text.split_once('/').and_then(|(number, count)| {
            Some((
                number.trim().parse::<usize>().ok()?,
                count.trim().parse::<usize>().ok()?,
            ))
        });
        match numbers {
            None => refused("expected NUMBER/COUNT"),
            Some((_, 0)) => refused("expected a count of at least 1"),
            Some((number, count)) if number == 0 || number > count => {
                refused("expected a number from 1 to the count")
            }
            Some((number, count)) => Ok(Self { number, count }),
        }
    }

    /// Returns true if this is the only shard.
    pub fn is_whole(self) -> bool {
        self.count == 1
    }

    /// Returns true if a chunk, counted from 0, belongs to this shard.
    pub fn contains(self, chunk: usize) -> bool {
        chunk % self.count == self.number - 1
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::Shard;

    #[test]
    fn every_chunk_belongs_to_one_shard() {
        let shards = ["1/3", "2/3", "3/3"].map(|text| Shard::parse(text).expect("a shard"));
        for chunk in 0..20 {
            let holders = shards.iter().filter(|shard| shard.contains(chunk)).count();
            assert_eq!(holders, 1, "chunk {chunk}");
            assert!(Shard::WHOLE.contains(chunk));
        }
    }

    #[test]
    fn invalid_shards_are_rejected() {
        for text in ["0/3", "4/3", "1/0", "0/0", "3", "a/b", "1/2/3", "-1/3", ""] {
            let error = Shard::parse(text).expect_err(text).to_string();
            assert!(error.contains("2/3"), "{text}: {error}");
        }
    }
}
