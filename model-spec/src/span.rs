//! Positions in a source, as byte offsets in its text. The source is a file, or the text that the macro generates
//! from its tokens.

use serde::Serialize;

/// Half-open range `start..end` of byte offsets in one source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub struct Span {
    /// First position of the range.
    pub start: usize,
    /// First position after the range.
    pub end: usize,
}

impl Span {
    /// Returns the range `start..end`.
    pub fn new(start: usize, end: usize) -> Self {
        Self { start, end }
    }

    /// Returns the smallest range that contains both.
    pub fn join(self, other: Self) -> Self {
        Self::new(self.start.min(other.start), self.end.max(other.end))
    }
}
