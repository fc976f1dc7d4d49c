//! Part of a file that a record uses.

use std::ops::Range;

/// Part of a file that a record uses.
pub(crate) struct UsedPart {
    pub rows: Range<usize>,
    /// Times of its first sample and of the one after its last, in s; infinite where the file ends.
    pub span: Range<f64>,
    /// Difference of the record's times and those of the file, in s.
    pub origin: f64,
}
