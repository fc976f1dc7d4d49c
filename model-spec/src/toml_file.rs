//! Files of TOML beside specifications: their text, and their tables with all places.

use std::path::Path;

use toml_edit::Document;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::source::Source;
use crate::span::Span;
use crate::table::{Entry, entries};

/// Reads a TOML file with `of`, which is given the entries of its first level.
///
/// # Errors
/// What is wrong with the file's grammar, or all that `of` finds.
pub fn read<T>(
    source: &Source,
    of: impl FnOnce(&[Entry<'_>], &mut Diagnostics) -> Option<T>,
) -> Result<T, Diagnostics> {
    let text: &str = &source.text;
    let toml = Document::parse(text)
        .map_err(|error| Diagnostics::one(source.clone(), grammar_error(text, &error)))?;
    let mut found = Diagnostics::new(source.clone());
    match of(&entries(toml.as_table(), text), &mut found) {
        Some(read) if found.is_empty() => Ok(read),
        _ => Err(found),
    }
}

/// The text of a file of at most so many bytes, UTF-8.
///
/// # Errors
/// Why it cannot be read.
pub fn source(path: &Path, limit: u64) -> Result<Source, Diagnostics> {
    let shown = path.display().to_string();
    let wrong = |message: String| {
        let message = format!("cannot read {shown}: {message}");
        Diagnostics::one(Source::new(shown.clone(), ""), Diagnostic::error(message))
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

/// What is wrong with the grammar of a file.
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
        Some("each name is given once in a section".to_owned())
    } else if behind_quotes && operator {
        Some("quotes enclose the whole expression: \"a^2\", not \"a\"^2".to_owned())
    } else {
        (!advice.is_empty()).then(|| advice.join("; "))
    };
    Diagnostic::error(format!("not valid TOML: {message}"))
        .at(Span::new(range.start, range.end), "here")
        .help_if(help)
}
