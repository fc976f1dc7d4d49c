//! Text of a specification, and positions in it.

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use sha2::{Digest, Sha256};

use crate::span::Span;

/// Named text.
#[derive(Clone, Debug)]
pub struct Source {
    /// Path of the file, as shown in messages.
    pub path: String,
    /// The whole text.
    pub text: Arc<str>,
    /// Folder of the file and of the tables that it names; `None` for a text without a file.
    pub folder: Option<Arc<Path>>,
    /// Files of a merged text.
    origin: Option<Arc<Origin>>,
}

/// Files of a merged text. The first file is the specification that extends the others.
#[derive(Debug)]
struct Origin {
    files: Vec<Source>,
    /// Parts, in the order of the text.
    parts: Vec<CopiedPart>,
}

/// Part of a merged text that was copied from a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CopiedPart {
    /// Position in the merged text.
    pub place: Span,
    /// Index of the file.
    pub file: usize,
    /// Position in the file.
    pub from: Span,
}

/// Position in a text; line and column start at 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Number of the line.
    pub line: usize,
    /// Number of the character in the line.
    pub column: usize,
}

impl Source {
    /// Creates a source from a text and the path to show for it.
    pub fn new(path: impl Into<String>, text: impl Into<Arc<str>>) -> Self {
        Self {
            path: path.into(),
            text: text.into(),
            folder: None,
            origin: None,
        }
    }

    /// Returns the source with the folder of its file.
    #[must_use]
    pub fn in_folder(mut self, folder: &Path) -> Self {
        self.folder = Some(folder.into());
        self
    }

    /// Returns the source with the merged text of several files.
    pub(crate) fn merged(&self, text: String, files: Vec<Source>, parts: Vec<CopiedPart>) -> Self {
        Self {
            text: text.into(),
            origin: Some(Arc::new(Origin { files, parts })),
            ..self.clone()
        }
    }

    /// Returns the paths of all files of the text, as shown in messages: the file itself, then the files that it
    /// extends.
    pub fn files(&self) -> Vec<&str> {
        match &self.origin {
            Some(origin) => origin.files.iter().map(|file| &*file.path).collect(),
            None => vec![&self.path],
        }
    }

    /// Returns the file that contains the start of a span, and the position in that file.
    pub fn locate(&self, span: Span) -> (&Source, Span) {
        let Some(origin) = &self.origin else {
            return (self, span);
        };
        let is_before = |part: &CopiedPart| match span.start < span.end {
            true => part.place.end <= span.start,
            false => part.place.end < span.start,
        };
        let first = origin.parts.partition_point(is_before);
        let Some(part) = origin.parts.get(first).or(origin.parts.last()) else {
            return (self, span);
        };
        let inside = |part: &CopiedPart, offset: usize| {
            let offset = offset.saturating_sub(part.place.start);
            (part.from.start + offset).min(part.from.end)
        };
        let start = inside(part, span.start);
        // A span may cover several consecutive parts of one file, for example a table.
        let follows = |next: &&CopiedPart| {
            next.file == part.file
                && next.from.start >= part.from.start
                && next.place.start < span.end
        };
        let parts = origin.parts.iter().skip(first).take_while(follows);
        let end = parts.last().map_or(start, |last| inside(last, span.end));
        (&origin.files[part.file], Span::new(start, end.max(start)))
    }

    /// Returns the source with another text, and the same path and folder.
    #[must_use]
    pub fn with_text(&self, text: impl Into<Arc<str>>) -> Self {
        Self {
            path: self.path.clone(),
            text: text.into(),
            folder: self.folder.clone(),
            origin: None,
        }
    }

    /// Returns the SHA-256 of the text as 64 lower-case hexadecimal digits.
    pub fn hash(&self) -> String {
        sha256(&*self.text)
    }

    /// Returns the line and column of a byte offset. An offset past the end is the end of the text;
    /// an offset inside a character is the position of that character.
    pub fn place(&self, offset: usize) -> Place {
        let offset = character_start(&self.text, offset);
        let before = &self.text[..offset];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Place {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }
}

/// Returns the start of the character that contains a byte offset, at most the end of the text.
/// Equals `str::floor_char_boundary`, which the oldest supported compiler lacks.
pub fn character_start(text: &str, offset: usize) -> usize {
    let mut start = offset.min(text.len());
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    start
}

/// Returns the SHA-256 of a text or a file as 64 lower-case hexadecimal digits.
pub fn sha256(content: impl AsRef<[u8]>) -> String {
    let digest = Sha256::digest(content);
    let mut digits = String::with_capacity(64);
    for byte in digest {
        // Writing to a String cannot fail.
        let _ = write!(digits, "{byte:02x}");
    }
    digits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hash_matches_the_published_value() {
        // FIPS 180-2, appendix B.1.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(Source::new("a.toml", "abc").hash(), expected);
    }

    #[test]
    fn places_count_characters_from_one() {
        let source = Source::new("a.toml", "ab\nµx\n");
        let place = |offset| {
            let Place { line, column } = source.place(offset);
            (line, column)
        };
        assert_eq!(place(0), (1, 1));
        assert_eq!(place(2), (1, 3));
        assert_eq!(place(3), (2, 1));
        assert_eq!(place(4), (2, 1), "inside the two bytes of µ");
        assert_eq!(place(5), (2, 2));
        assert_eq!(place(999), (3, 1));
    }
}
