//! Reads TOML files: their text, and their tables with positions.

use std::path::Path;

use toml_edit::Document;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::greek::spell_greek;
use crate::source::Source;
use crate::span::Span;
use crate::table::{Entry, entries};
use crate::unit::Unit;

/// Reads a TOML file and passes the entries of its top level to `of`.
///
/// # Errors
/// The first TOML syntax error, or all errors of `of`.
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
/// The file is missing, too large, not readable or not UTF-8.
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
    let other = foreign_grammar(text, range.start.min(text.len()));
    let help = if message == "duplicate key" {
        Some("give each name once in a section".to_owned())
    } else if behind_quotes && operator {
        Some("quotes enclose the whole expression: \"a^2\", not \"a\"^2".to_owned())
    } else if let Some(help) = other {
        Some(help)
    } else {
        (!advice.is_empty()).then(|| advice.join("; "))
    };
    Diagnostic::error(format!("not valid TOML: {message}"))
        .with_span(Span::new(range.start, range.end), "here")
        .with_optional_help(help)
}

/// If the text at a syntax error is a notation of another language, returns the TOML notation.
fn foreign_grammar(text: &str, place: usize) -> Option<String> {
    let start = text[..place].rfind('\n').map_or(0, |end| end + 1);
    let line = text[start..].lines().next().unwrap_or_default();
    let written = line.trim_start();
    if ["%", "//", "/*", "--", ";"]
        .iter()
        .any(|mark| written.starts_with(mark))
    {
        return Some("a comment begins with #".to_owned());
    }
    let (key, value) = line
        .split_once('=')
        .map_or((line, None), |(k, v)| (k, Some(v)));
    if place < start + key.len() {
        let spelled = spell_greek(key.trim())?;
        return Some(format!(
            "a name has letters a-z and A-Z, digits and `_`: write {spelled}"
        ));
    }
    value?;
    if let Some(number) = decimal_comma(line) {
        return Some(format!("a decimal number has a point: write {number}"));
    }
    let before = text[start..place].trim_end();
    let value = expression_of(&line[place - start..]);
    if !before.ends_with('=') || value.is_empty() || value.starts_with(['"', '\'', '[', '{']) {
        return None;
    }
    match Unit::parse_quantity(value) {
        Some((number, unit)) if before.contains('{') => {
            Some(format!("write value = {number}, unit = \"{unit}\""))
        }
        Some((number, unit)) => Some(format!("write {{ value = {number}, unit = \"{unit}\" }}")),
        None => Some(format!(
            "quotes enclose an expression or a text: \"{value}\""
        )),
    }
}

/// Returns an expression without quotes: up to the end of the line, or to the first comma or brace outside its brackets.
fn expression_of(value: &str) -> &str {
    let mut depth = 0_i32;
    let end = value.char_indices().find(|(_, letter)| {
        depth += i32::from("([".contains(*letter)) - i32::from(")]".contains(*letter));
        depth < 0 || "#}\n".contains(*letter) || (*letter == ',' && depth == 0)
    });
    value[..end.map_or(value.len(), |(end, _)| end)].trim()
}

/// Returns the first number of a line with a decimal comma, written with a point.
fn decimal_comma(line: &str) -> Option<String> {
    let is_digit = |letter: char| letter.is_ascii_digit();
    line.match_indices(',').find_map(|(place, _)| {
        let (before, after) = (&line[..place], &line[place + 1..]);
        let whole = before.len() - before.trim_end_matches(is_digit).len();
        let decimals = after.len() - after.trim_start_matches(is_digit).len();
        let is_number = whole > 0 && decimals > 0 && !before.contains('[');
        let number = || format!("{}.{}", &before[before.len() - whole..], &after[..decimals]);
        is_number.then(number)
    })
}
