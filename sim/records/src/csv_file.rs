//! Numeric columns of a text file, with line numbers for error messages.

use std::borrow::Cow;
use std::path::Path;

use csv::{ByteRecord, Position, Reader, ReaderBuilder};
use eomgen_model_spec::hidden_characters::escape_hidden;
use eomgen_model_spec::unit::Unit;

use crate::description::columns::ColumnKey;
use crate::description::format::{Format, Separator};
use crate::header::{COMMENT, MAX_SAMPLES, Table, find_columns, too_many_samples_error};
use crate::number::{parse_decimal, parse_number};
use crate::proposal::layout::detect_layout;
use crate::refusal::Refusal;

/// Separator of cells that replaces runs of spaces: the ASCII unit separator.
const UNIT_SEPARATOR: u8 = 0x1f;

/// Number of bytes at the start of the file from which the encoding is detected.
const EXAMINED_BYTES: usize = 16;

/// Byte order marks of UTF-16.
const UTF_16: [&[u8]; 2] = [&[0xff, 0xfe], &[0xfe, 0xff]];

/// Reads columns; a missing number becomes NaN.
pub fn read_columns(
    path: &Path,
    bytes: &[u8],
    format: &Format,
    wanted: &[&ColumnKey],
) -> Result<Table, Refusal> {
    let text = skip_lines(path, bytes, format)?;
    let mut file = TextFile::new(path, &text, format)?;
    let places =
        find_columns(path, file.first_line, &file.header, wanted).map_err(|refusal| match file
            .header[0]
            .starts_with(COMMENT)
        {
            true => refusal,
            false => names_below_error(path, bytes, format, wanted).unwrap_or(refusal),
        })?;
    let mut table = Table {
        columns: vec![Vec::new(); wanted.len()],
        lines: Vec::new(),
        decimals: Vec::new(),
    };
    while let Some((line, record)) = file.next_record()? {
        if table.lines.len() == MAX_SAMPLES {
            return Err(too_many_samples_error(path));
        }
        table.lines.push(line);
        if let Some(place) = places.first() {
            let cell = record.get(*place).unwrap_or_default();
            table.decimals.push(parse_decimal(cell, format.decimal));
        }
        for (column, place) in table.columns.iter_mut().zip(&places) {
            let cell = record.get(*place).unwrap_or_default();
            column.push(read_number(path, line, cell, *place, format.decimal)?);
        }
    }
    Ok(table)
}

pub(crate) struct TextFile<'t> {
    path: &'t Path,
    reader: Reader<&'t [u8]>,
    /// Names of the columns, or their numbers if the file has no names.
    pub header: Vec<String>,
    pub first_line: u64,
    pub units: Vec<String>,
    skipped_lines: u64,
    record: ByteRecord,
    /// True if the first line contains numbers and has not been returned yet.
    is_pending: bool,
}

impl<'t> TextFile<'t> {
    /// Reads names and units. `text` is the file after the skipped lines.
    pub fn new(path: &'t Path, text: &'t [u8], format: &Format) -> Result<Self, Refusal> {
        let reader = ReaderBuilder::new()
            .flexible(true)
            .has_headers(false)
            .comment(format.comment)
            .delimiter(match format.separator {
                Separator::Character(character) => character,
                Separator::Spaces => UNIT_SEPARATOR,
            })
            .from_reader(text);
        let mut file = Self {
            path,
            reader,
            header: Vec::new(),
            first_line: 1,
            units: Vec::new(),
            skipped_lines: format.skip as u64,
            record: ByteRecord::new(),
            is_pending: false,
        };
        let empty = "is empty; expected a line of column names and a line per sample";
        if !file.advance()? || file.is_blank() {
            return Err(Refusal::file_error(path, empty));
        }
        file.first_line = file.line();
        file.header = file.cells();
        let are_numbers = |cells: &[String]| {
            let is_number = |cell: &String| parse_number(cell, format.decimal).is_some();
            cells.len() > 1 && cells.iter().all(is_number)
        };
        if format.has_names && are_numbers(&file.header) {
            return Err(Refusal::line_error(
                path,
                file.first_line,
                "found numbers, expected the names of the columns; write names = false in [format], and give columns by number",
            ));
        }
        if !format.has_names {
            file.header = (1..=file.record.len()).map(|n| n.to_string()).collect();
        }
        file.is_pending = !format.has_names;
        if format.has_units {
            if !format.has_names {
                file.units = file.cells();
                file.is_pending = false;
            } else if file.advance()? {
                file.units = file.cells();
            }
        }
        Ok(file)
    }

    fn cells(&self) -> Vec<String> {
        let cells = self.record.iter();
        cells
            .map(|cell| String::from_utf8_lossy(cell).trim().to_owned())
            .collect()
    }

    fn line(&self) -> u64 {
        self.record.position().map_or(0, Position::line) + self.skipped_lines
    }

    fn is_blank(&self) -> bool {
        let mut cells = self.record.iter();
        cells.all(|cell| cell.trim_ascii().is_empty())
    }

    fn advance(&mut self) -> Result<bool, Refusal> {
        let read = self.reader.read_byte_record(&mut self.record);
        read.map_err(|error| Refusal::file_error(self.path, error.to_string()))
    }

    pub fn next_record(&mut self) -> Result<Option<(u64, &ByteRecord)>, Refusal> {
        let mut is_pending = std::mem::take(&mut self.is_pending);
        // Spreadsheets write lines of spaces or separators after the last sample.
        while !is_pending || self.is_blank() {
            is_pending = self.advance()?;
            if !is_pending {
                return Ok(None);
            }
        }
        let line = self.line();
        let (cells, expected) = (self.record.len(), self.header.len());
        // Some programs write a separator at the end of lines of numbers, but not of the line of names.
        let is_open = cells == expected + 1 && self.record[expected].trim_ascii().is_empty();
        if cells != expected && !is_open {
            return Err(Refusal::line_error(
                self.path,
                line,
                format!(
                    "has {cells} cells, but the first line has {expected}; the file may be truncated"
                ),
            ));
        }
        Ok(Some((line, &self.record)))
    }
}

/// Returns the text after the skipped lines, as UTF-8 with one character between cells.
pub(crate) fn skip_lines<'b>(
    path: &Path,
    bytes: &'b [u8],
    format: &Format,
) -> Result<Cow<'b, [u8]>, Refusal> {
    if UTF_16.iter().any(|mark| bytes.starts_with(mark)) || has_wide_characters(bytes) {
        return Err(Refusal::file_error(
            path,
            "is UTF-16; expected UTF-8 or ASCII",
        ));
    }
    let mut text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    // If the text has no line feeds, carriage returns end the lines.
    let is_end = match text.contains(&b'\n') {
        true => |byte: &u8| *byte == b'\n',
        false => |byte: &u8| *byte == b'\r',
    };
    for _ in 0..format.skip {
        let Some(end) = text.iter().position(is_end) else {
            return Err(Refusal::file_error(
                path,
                format!(
                    "has no line after the {} skipped lines; reduce skip in [format]",
                    format.skip
                ),
            ));
        };
        text = &text[end + 1..];
    }
    if format.separator != Separator::Spaces {
        return Ok(Cow::Borrowed(text));
    }
    let mut parted = Vec::with_capacity(text.len());
    for line in text.split(is_end) {
        let words = line.split(u8::is_ascii_whitespace);
        for word in words.filter(|word| !word.is_empty()) {
            parted.extend_from_slice(word);
            parted.push(UNIT_SEPARATOR);
        }
        if parted.last() == Some(&UNIT_SEPARATOR) {
            parted.pop();
        }
        parted.push(b'\n');
    }
    Ok(Cow::Owned(parted))
}

/// Returns true if every second byte at the beginning is zero, as in UTF-16 without a byte order mark.
fn has_wide_characters(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(EXAMINED_BYTES)];
    let has_pairs = |zero: usize| {
        let mut pairs = head.chunks_exact(2);
        pairs.all(|pair| pair[zero] == 0 && pair[1 - zero] != 0)
    };
    head.len() > 3 && (has_pairs(0) || has_pairs(1))
}

/// Returns the error for names that follow other lines, with the number of lines to skip.
fn names_below_error(
    path: &Path,
    bytes: &[u8],
    format: &Format,
    wanted: &[&ColumnKey],
) -> Option<Refusal> {
    let layout = detect_layout(&String::from_utf8_lossy(bytes))?;
    let is_there = |key: &&ColumnKey| match key {
        ColumnKey::Name(name) => layout.names.contains(&name.text),
        ColumnKey::Number(..) => true,
    };
    let found = &layout.format;
    let differs_in_lines = found.separator == format.separator && found.skip != format.skip;
    (differs_in_lines && format.has_names && wanted.iter().all(is_there)).then(|| {
        let line = found.skip + 1;
        let names = layout.names.join(", ");
        Refusal::file_error(
            path,
            format!(
                "the names of the columns, {}, are in line {line}; write skip = {} in [format]",
                escape_hidden(&names),
                found.skip
            ),
        )
    })
}

fn read_number(
    path: &Path,
    line: u64,
    cell: &[u8],
    place: usize,
    decimal: u8,
) -> Result<f64, Refusal> {
    let cell = String::from_utf8_lossy(cell.trim_ascii());
    if cell.is_empty() {
        return Ok(f64::NAN);
    }
    if let Some(value) = parse_number(&cell, decimal) {
        if value.is_infinite() {
            return Err(Refusal::line_error(
                path,
                line,
                format!(
                    "column {}: \"{cell}\" is not a finite number; leave the cell of a missing sample empty",
                    place + 1
                ),
            ));
        }
        return Ok(value);
    }
    let other = if decimal == b'.' { ',' } else { '.' };
    let is_other = parse_number(&cell, other as u8).is_some();
    let help = match (is_other, other) {
        (true, ',') => "; write decimal = \",\" in [format] if its decimal sign is a comma",
        (true, _) => ": [format] sets decimal = \",\", so a point is not allowed",
        (false, _) if Unit::parse(&cell).is_ok() => {
            "; write units = true in [format] if a line of units follows the names"
        }
        (false, _) => "",
    };
    let shown: String = cell.chars().take(40).collect();
    Err(Refusal::line_error(
        path,
        line,
        format!("column {}: \"{shown}\" is not a number{help}", place + 1),
    ))
}
