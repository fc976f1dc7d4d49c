//! Text built from tokens, with the source token of each part.

use std::ops::Range;

use eomgen_model_spec::span::Span as Bytes;
use proc_macro2::Span;

/// Text and the tokens of its parts.
#[derive(Default)]
pub struct PlacedText {
    /// The text.
    pub text: String,
    /// Byte ranges in ascending order, without overlap.
    marks: Vec<(Range<usize>, Span)>,
}

impl PlacedText {
    /// Appends text that has no token.
    pub fn push(&mut self, text: &str) {
        self.text.push_str(text);
    }

    /// Appends the text of a token.
    pub fn push_token(&mut self, text: &str, span: Span) {
        let start = self.text.len();
        self.text.push_str(text);
        self.marks.push((start..self.text.len(), span));
    }

    /// Returns the first and the last token of a byte range. If the range contains no token, both are the last token
    /// before it, or the first token of the text if none precedes. Returns `None` if the text has no token.
    pub fn token_range(&self, bytes: Bytes) -> Option<(Span, Span)> {
        let (first, last) = self.mark_range(bytes)?;
        Some((self.marks[first].1, self.marks[last].1))
    }

    /// Returns the text of the tokens of a byte range.
    pub fn token_text(&self, bytes: Bytes) -> Option<&str> {
        let (first, last) = self.mark_range(bytes)?;
        self.text
            .get(self.marks[first].0.start..self.marks[last].0.end)
    }

    fn mark_range(&self, bytes: Bytes) -> Option<(usize, usize)> {
        // An empty range is treated as the next byte.
        let (start, end) = (bytes.start, bytes.end.max(bytes.start + 1));
        let first = self.marks.partition_point(|(range, _)| range.end <= start);
        let after = self.marks.partition_point(|(range, _)| range.start < end);
        match after.checked_sub(1) {
            Some(last) => Some((first.min(last), last)),
            None => (!self.marks.is_empty()).then_some((0, 0)),
        }
    }
}
