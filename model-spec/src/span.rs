//! Positions in a source: byte offsets in its text. The text may be a file's or one that a
//! macro wrote down from its tokens; nothing here knows which.

use serde::Serialize;

/// A half-open range `start..end` of positions in one source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub struct Span {
    /// First position of the range.
    pub start: usize,
    /// First position after the range.
    pub end: usize,
}

impl Span {
    /// The range `start..end`.
    pub fn new(start: usize, end: usize) -> Self {
        Self { start, end }
    }

    /// The smallest range that holds both.
    pub fn join(self, other: Self) -> Self {
        Self::new(self.start.min(other.start), self.end.max(other.end))
    }
}
