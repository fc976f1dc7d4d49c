//! Reads TOML files: their text, and their tables with positions.

use std::path::Path;

use toml_edit::Document;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::source::Source;
use crate::span::Span;
use crate::table::{Entry, entries};

/// Reads a TOML file with `of`, which receives the entries of the top level.
///
/// # Errors
/// The first error of the TOML grammar, or all findings of `of`.
pub fn read<T>(
    source: &Source,
    of: impl FnOnce(&[Entry<'_>], &mut Diagnostics) -> Option<T>,
) -> Result<T, Diagnostics> {
    let text: &str = &source.text;
    let toml = Document::parse(text)
        .map_err(|error| Diagnostics::from_one(source.clone(), grammar_error(text, &error)))?;
    let mut found = Diagnostics::new(source.clone());
    match of(&entries(toml.as_table(), text), &mut found) {
        Some(read) if found.is_empty() => Ok(read),
        _ => Err(found),
    }
}

/// Reads a UTF-8 file of at most `limit` bytes.
///
/// # Errors
/// A file that is missing, too large, unreadable or not UTF-8.
pub fn source(path: &Path, limit: u64) -> Result<Source, Diagnostics> {
    let shown = path.display().to_string();
    let wrong = |message: String| {
        let message = format!("cannot read {shown}: {message}");
        Diagnostics::from_one(Source::new(shown.clone(), ""), Diagnostic::error(message))
    };
    let metadata = std::fs::metadata(path).map_err(|error| wrong(error.to_string()))?;
    if !metadata.is_file() {
        return Err(wrong("it is not a file".to_owned()));
    }
    if metadata.len() > limit {
        return Err(wrong(format!(
            "it has {} bytes; the limit is {limit}",
            metadata.len()
        )));
    }
    let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
    Ok(Source::new(shown.clone(), text))
}

pub(crate) fn grammar_error(text: &str, error: &toml_edit::TomlError) -> Diagnostic {
    let range = error.span().unwrap_or(text.len()..text.len());
    let mut lines = error.message().lines();
    let message = lines.next().unwrap_or("this is not TOML").trim();
    let advice: Vec<&str> = lines
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .collect();
    let behind_quotes = text[..range.start.min(text.len())].ends_with(['"', '\'']);
    let operator = text[range.start.min(text.len())..].starts_with(['^', '*', '/', '+', '-']);
    let help = if message == "duplicate key" {
        Some("give each name once in a section".to_owned())
    } else if behind_quotes && operator {
        Some("quotes enclose the whole expression: \"a^2\", not \"a\"^2".to_owned())
    } else {
        (!advice.is_empty()).then(|| advice.join("; "))
    };
    Diagnostic::error(format!("not valid TOML: {message}"))
        .with_span(Span::new(range.start, range.end), "here")
        .with_optional_help(help)
}
