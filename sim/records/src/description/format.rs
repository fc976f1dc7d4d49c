//! Table `[format]`: layout of a text file with numbers.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quote};
use eomgen_model_spec::record::Record;
use eomgen_model_spec::span::Span;
use eomgen_model_spec::table::Entry;

use super::keys;

/// Separator of the cells in a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Separator {
    /// One character.
    Character(u8),
    /// Any number of spaces and tabs.
    Spaces,
}

/// Separators with their names.
pub const SEPARATORS: [(&str, Separator); 5] = [
    (",", Separator::Character(b',')),
    (";", Separator::Character(b';')),
    ("|", Separator::Character(b'|')),
    ("tab", Separator::Character(b'\t')),
    ("spaces", Separator::Spaces),
];

/// Decimal signs with their names.
pub const DECIMALS: [(&str, u8); 2] = [(".", b'.'), (",", b',')];

const MAX_SKIPPED_LINES: i64 = 1000;

/// Layout of a text file with numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    /// Separator of the cells.
    pub separator: Separator,
    /// Decimal sign.
    pub decimal: u8,
    /// Number of lines to skip at the start.
    pub skip: usize,
    /// First character of comment lines, if any.
    pub comment: Option<u8>,
    /// True if the first line contains the names of the columns.
    pub has_names: bool,
    /// True if a line of units precedes the numbers.
    pub has_units: bool,
}

impl Default for Format {
    fn default() -> Self {
        Self {
            separator: Separator::Character(b','),
            decimal: b'.',
            skip: 0,
            comment: None,
            has_names: true,
            has_units: false,
        }
    }
}

/// Reads the table.
pub fn read_format(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<Format> {
    let record = Record::read(entry, &keys::FORMAT, found)?;
    let usual = Format::default();
    let separator = record.optional("separator", |entry| entry.keyword(&SEPARATORS), found);
    let separator = separator.unwrap_or(usual.separator);
    let decimal = record.optional("decimal", |entry| entry.keyword(&DECIMALS), found);
    let decimal = decimal.unwrap_or(usual.decimal);
    let mut boolean = |key: &str| record.optional(key, Entry::boolean, found);
    let (names, units) = (boolean("names"), boolean("units"));
    let format = Format {
        separator,
        decimal,
        skip: read_skip(&record, found)?,
        comment: read_comment(&record, found)?,
        has_names: names.unwrap_or(usual.has_names),
        has_units: units.unwrap_or(usual.has_units),
    };
    if separator == Separator::Character(decimal) {
        let decimal = record.get("decimal").map_or(entry.span(), Entry::span);
        found.push(
            Diagnostic::error("a comma cannot be both the separator and the decimal sign")
                .with_span(decimal, "this is also the separator")
                .with_help("write separator = \";\", or the separator of the file"),
        );
    }
    Some(format)
}

fn read_skip(record: &Record<'_>, found: &mut Diagnostics) -> Option<usize> {
    let Some(entry) = record.get("skip") else {
        return Some(0);
    };
    let (count, span) = found.push_error(entry.integer())?;
    match usize::try_from(count)
        .ok()
        .filter(|_| count <= MAX_SKIPPED_LINES)
    {
        Some(count) => Some(count),
        None => {
            found.push(line_count_error(count, span));
            None
        }
    }
}

fn line_count_error(count: i64, span: Span) -> Diagnostic {
    Diagnostic::error(format!("`skip` cannot be {count}")).with_span(
        span,
        format!("expected the number of lines before the columns, 0 to {MAX_SKIPPED_LINES}"),
    )
}

fn read_comment(record: &Record<'_>, found: &mut Diagnostics) -> Option<Option<u8>> {
    let Some(entry) = record.get("comment") else {
        return Some(None);
    };
    let written = found.push_error(entry.written())?;
    match written.text.as_bytes() {
        [one] if one.is_ascii_punctuation() => Some(Some(*one)),
        _ => {
            found.push(
                Diagnostic::error(format!("`comment` cannot be {}", quote(&written.text)))
                    .with_span(written.span, "expected one character, such as \"#\""),
            );
            None
        }
    }
}
