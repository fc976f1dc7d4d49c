//! Columns of numbers from a CSV or Parquet file, with the line that each fault is on. What
//! the columns mean is not known here.

use std::path::Path;

use crate::header::{MOST_SAMPLES, places, too_many};
use crate::parquet_file;
use crate::refusal::Refusal;

/// The largest record read, in bytes.
const LARGEST_RECORD: u64 = 256 << 20;

/// Reads these columns of a file; a missing number, `NaN`, an infinity or an empty cell is
/// NaN.
///
/// # Errors
/// A file that cannot be read or is too large, a column that is not there, a cell that is no
/// number, with file, line and column.
pub fn read(path: &Path, wanted: &[&str]) -> Result<Vec<Vec<f64>>, Refusal> {
    let metadata = std::fs::metadata(path)
        .map_err(|error| Refusal::file(path, format!("cannot be read: {error}")))?;
    if !metadata.is_file() {
        return Err(Refusal::file(
            path,
            "is not a file; expected CSV or Parquet",
        ));
    }
    if metadata.len() > LARGEST_RECORD {
        return Err(Refusal::file(
            path,
            format!(
                "has {} bytes; at most {LARGEST_RECORD} are read: cut the record, or sample it less often",
                metadata.len()
            ),
        ));
    }
    if metadata.len() == 0 {
        return Err(Refusal::file(
            path,
            "is empty; expected a line of column names and a line per sample",
        ));
    }
    let bytes = std::fs::read(path)
        .map_err(|error| Refusal::file(path, format!("cannot be read: {error}")))?;
    if path.extension().is_some_and(|e| e == "parquet") {
        parquet_file::read(path, bytes, wanted)
    } else {
        read_csv(path, &bytes, wanted)
    }
}

fn read_csv(path: &Path, bytes: &[u8], wanted: &[&str]) -> Result<Vec<Vec<f64>>, Refusal> {
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(bytes);
    let headers = reader
        .headers()
        .map_err(|error| Refusal::file(path, error.to_string()))?
        .clone();
    let there: Vec<&str> = headers.iter().collect();
    if there.iter().all(|name| name.trim().is_empty()) {
        return Err(Refusal::file(
            path,
            "is empty; expected a line of column names and a line per sample",
        ));
    }
    if let [one] = there[..]
        && wanted.len() > 1
        && one.contains([';', '\t'])
    {
        return Err(Refusal::line(
            path,
            1,
            "the columns are parted by semicolons or tabs; expected commas",
        ));
    }
    let places = places(path, &there, wanted)?;
    let mut columns = vec![Vec::new(); wanted.len()];
    for record in reader.records() {
        let record = record.map_err(|error| Refusal::file(path, error.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        if columns[0].len() == MOST_SAMPLES {
            return Err(too_many(path));
        }
        if record.len() != there.len() {
            return Err(Refusal::line(
                path,
                line,
                format!(
                    "has {} cells where the first line has {}; the file may be cut off",
                    record.len(),
                    there.len()
                ),
            ));
        }
        for (column, place) in columns.iter_mut().zip(&places) {
            column.push(number(
                path,
                line,
                record.get(*place).unwrap_or_default(),
                *place,
            )?);
        }
    }
    Ok(columns)
}

fn number(path: &Path, line: u64, cell: &str, place: usize) -> Result<f64, Refusal> {
    let cell = cell.trim();
    if cell.is_empty() {
        return Ok(f64::NAN);
    }
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Ok(f64::NAN),
        Err(_) => {
            let shown: String = cell.chars().take(40).collect();
            Err(Refusal::line(
                path,
                line,
                format!("column {}: \"{shown}\" is no number", place + 1),
            ))
        }
    }
}
