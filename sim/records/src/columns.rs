//! Numeric columns of a text or Parquet file.

use std::path::Path;

use crate::csv_file;
use crate::description::columns::ColumnKey;
use crate::description::format::Format;
use crate::header::Table;
use crate::parquet_file;
use crate::refusal::Refusal;

const MAX_RECORD_BYTES: u64 = 256 << 20;

/// Reads columns of a file. A missing number, `NaN` or an empty cell becomes NaN.
///
/// # Errors
/// A file that is unreadable or too large, a missing column, or a cell that is infinite or not a number.
pub fn read_columns(path: &Path, format: &Format, wanted: &[&ColumnKey]) -> Result<Table, Refusal> {
    let bytes = read_bytes(path)?;
    if path.extension().is_some_and(|e| e == "parquet") {
        parquet_file::read_columns(path, bytes, wanted)
    } else {
        csv_file::read_columns(path, &bytes, format, wanted)
    }
}

pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, Refusal> {
    let metadata = std::fs::metadata(path)
        .map_err(|error| Refusal::file_error(path, format!("cannot be read: {error}")))?;
    if !metadata.is_file() {
        return Err(Refusal::file_error(
            path,
            "is not a file; expected CSV or Parquet",
        ));
    }
    let ends_in = |kind: &str| {
        path.extension()
            .is_some_and(|end| end.eq_ignore_ascii_case(kind))
    };
    if ["npz", "mat"].into_iter().any(ends_in) {
        return Err(Refusal::file_error(
            path,
            "contains NumPy or MATLAB arrays; expected text or Parquet: convert it with \
             eomgen.record_to_csv(source, out) in Python",
        ));
    }
    if metadata.len() > MAX_RECORD_BYTES {
        return Err(Refusal::file_error(
            path,
            format!(
                "has {} bytes, more than the limit of {MAX_RECORD_BYTES}: split the record, or reduce its sampling rate",
                metadata.len()
            ),
        ));
    }
    if metadata.len() == 0 {
        return Err(Refusal::file_error(
            path,
            "is empty; expected a line of column names and a line per sample",
        ));
    }
    std::fs::read(path)
        .map_err(|error| Refusal::file_error(path, format!("cannot be read: {error}")))
}
