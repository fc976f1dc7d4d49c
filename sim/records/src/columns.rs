//! Columns of numbers from a file of text or Parquet. What the columns mean is not known here.

use std::path::Path;

use crate::csv_file;
use crate::description::columns::ColumnKey;
use crate::description::format::Format;
use crate::header::Table;
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
pub fn read(path: &Path, format: &Format, wanted: &[&ColumnKey]) -> Result<Table, Refusal> {
    let bytes = bytes(path)?;
    if path.extension().is_some_and(|e| e == "parquet") {
        parquet_file::read(path, bytes, wanted)
    } else {
        csv_file::read(path, &bytes, format, wanted)
    }
}

/// The bytes of a record.
///
/// # Errors
/// A file that cannot be read, is too large, or holds nothing.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, Refusal> {
    let metadata = std::fs::metadata(path)
        .map_err(|error| Refusal::file(path, format!("cannot be read: {error}")))?;
    if !metadata.is_file() {
        return Err(Refusal::file(
            path,
            "is not a file; expected CSV or Parquet",
        ));
    }
    let ends_in = |kind: &str| {
        path.extension()
            .is_some_and(|end| end.eq_ignore_ascii_case(kind))
    };
    if ["npz", "mat"].into_iter().any(ends_in) {
        return Err(Refusal::file(
            path,
            "holds arrays of NumPy or MATLAB; expected text or Parquet: in Python, \
             eomgen.record_to_csv(source, out) writes one as the other",
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
    std::fs::read(path).map_err(|error| Refusal::file(path, format!("cannot be read: {error}")))
}
