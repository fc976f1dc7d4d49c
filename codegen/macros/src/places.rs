//! A text made from tokens that knows which token each part of it came from. What the text
//! says is not looked at.

use std::ops::Range;

use eomgen_model_spec::span::Span as Bytes;
use proc_macro2::Span;

/// A text and the origins of its parts.
#[derive(Default)]
pub struct Placed {
    /// The text.
    pub text: String,
    /// Parts in the order of the text, without overlap.
    marks: Vec<(Range<usize>, Span)>,
}

impl Placed {
    /// Goes on with text of nobody's.
    pub fn add(&mut self, text: &str) {
        self.text.push_str(text);
    }

    /// Goes on with the text of a token.
    pub fn mark(&mut self, text: &str, span: Span) {
        let start = self.text.len();
        self.text.push_str(text);
        self.marks.push((start..self.text.len(), span));
    }

    /// The first and last token of a range of the text; where no token is, the last one
    /// before it, else the first of all. None if the text has no token.
    pub fn tokens(&self, bytes: Bytes) -> Option<(Span, Span)> {
        let (first, last) = self.found(bytes)?;
        Some((self.marks[first].1, self.marks[last].1))
    }

    /// The text of these tokens.
    pub fn shown(&self, bytes: Bytes) -> Option<&str> {
        let (first, last) = self.found(bytes)?;
        self.text
            .get(self.marks[first].0.start..self.marks[last].0.end)
    }

    fn found(&self, bytes: Bytes) -> Option<(usize, usize)> {
        // An empty range is the place of what follows it.
        let (start, end) = (bytes.start, bytes.end.max(bytes.start + 1));
        let first = self.marks.partition_point(|(range, _)| range.end <= start);
        let after = self.marks.partition_point(|(range, _)| range.start < end);
        match after.checked_sub(1) {
            Some(last) => Some((first.min(last), last)),
            None => (!self.marks.is_empty()).then_some((0, 0)),
        }
    }
}
