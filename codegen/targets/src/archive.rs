//! ZIP archives. Equal contents give equal bytes: all entries have the same time.

use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::error::{EmissionError, Result};

/// Packs files, each a name and its content, into an archive.
///
/// # Errors
/// Names that an archive does not support.
pub fn pack(files: Vec<(String, Vec<u8>)>) -> Result<Vec<u8>> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let failed =
        |error: &dyn std::fmt::Display| EmissionError::Request(format!("cannot pack: {error}"));
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, contents) in files {
        archive
            .start_file(name, options)
            .map_err(|error| failed(&error))?;
        archive
            .write_all(&contents)
            .map_err(|error| failed(&error))?;
    }
    let archive = archive.finish().map_err(|error| failed(&error))?;
    Ok(archive.into_inner())
}
