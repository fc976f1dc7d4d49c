//! `[format]`: how the numbers of a record stand in its file, where that is text.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quoted};
use eomgen_model_spec::span::Span;
use eomgen_model_spec::table::{Entry, Record};

use super::keys;

/// What parts the cells of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Separator {
    /// One character.
    Character(u8),
    /// Spaces and tabs, as many as there are.
    Spaces,
}

/// The words for separators.
pub const SEPARATORS: [(&str, Separator); 5] = [
    (",", Separator::Character(b',')),
    (";", Separator::Character(b';')),
    ("|", Separator::Character(b'|')),
    ("tab", Separator::Character(b'\t')),
    ("spaces", Separator::Spaces),
];

/// The decimal signs.
pub const DECIMALS: [(&str, u8); 2] = [(".", b'.'), (",", b',')];

/// The most lines that are skipped.
const MOST_SKIPPED: i64 = 1000;

/// How a text file of numbers is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    /// Between the cells.
    pub separator: Separator,
    /// Before the digits of fractions.
    pub decimal: u8,
    /// Lines before everything else.
    pub skip: usize,
    /// What a line that says nothing begins with.
    pub comment: Option<u8>,
    /// Whether the first line has the columns' names.
    pub names: bool,
    /// Whether a line of units stands before the numbers.
    pub units: bool,
}

impl Default for Format {
    fn default() -> Self {
        Self {
            separator: Separator::Character(b','),
            decimal: b'.',
            skip: 0,
            comment: None,
            names: true,
            units: false,
        }
    }
}

/// Reads the table.
pub fn read(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<Format> {
    let record = entry.record(&keys::FORMAT, "{ separator = \";\" }", found)?;
    let usual = Format::default();
    let separator = match record.get("separator") {
        Some(separator) => found.keep(separator.word(&SEPARATORS))?,
        None => usual.separator,
    };
    let decimal = match record.get("decimal") {
        Some(decimal) => found.keep(decimal.word(&DECIMALS))?,
        None => usual.decimal,
    };
    let format = Format {
        separator,
        decimal,
        skip: skipped(&record, found)?,
        comment: comment(&record, found)?,
        names: truth(&record, "names", usual.names, found)?,
        units: truth(&record, "units", usual.units, found)?,
    };
    if separator == Separator::Character(decimal) {
        let decimal = record.get("decimal").map_or(entry.span(), Entry::span);
        found.push(
            Diagnostic::error("a comma cannot both part columns and begin fractions")
                .at(decimal, "this is the separator too")
                .help("write separator = \";\", or what the file has between its columns"),
        );
    }
    Some(format)
}

fn truth(record: &Record<'_>, key: &str, usual: bool, found: &mut Diagnostics) -> Option<bool> {
    match record.get(key) {
        Some(entry) => found.keep(entry.truth()),
        None => Some(usual),
    }
}

fn skipped(record: &Record<'_>, found: &mut Diagnostics) -> Option<usize> {
    let Some(entry) = record.get("skip") else {
        return Some(0);
    };
    let (count, span) = found.keep(entry.whole())?;
    match usize::try_from(count)
        .ok()
        .filter(|_| count <= MOST_SKIPPED)
    {
        Some(count) => Some(count),
        None => {
            found.push(lines(count, span));
            None
        }
    }
}

fn lines(count: i64, span: Span) -> Diagnostic {
    Diagnostic::error(format!("{count} lines cannot be skipped")).at(
        span,
        format!("expected how many lines stand before the columns: 0 to {MOST_SKIPPED}"),
    )
}

/// The first character of lines that say nothing.
fn comment(record: &Record<'_>, found: &mut Diagnostics) -> Option<Option<u8>> {
    let Some(entry) = record.get("comment") else {
        return Some(None);
    };
    let written = found.keep(entry.written())?;
    match written.text.as_bytes() {
        [one] if one.is_ascii_punctuation() => Some(Some(*one)),
        _ => {
            found.push(
                Diagnostic::error(format!(
                    "no line of comment begins with {}",
                    quoted(&written.text)
                ))
                .at(written.span, "expected one character, as \"#\""),
            );
            None
        }
    }
}
