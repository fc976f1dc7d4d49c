//! Part of a file that a record uses.

use std::ops::Range;

/// Part of a file that a record uses.
pub(crate) struct UsedPart {
    pub rows: Range<usize>,
    /// Times of its first sample and of the first sample after it, in s; infinite at the ends of the file.
    pub span: Range<f64>,
    /// Time in the file at which the record's times are 0, in s.
    pub origin: f64,
}
