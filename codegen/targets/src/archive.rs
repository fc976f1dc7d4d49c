//! ZIP archives. All entries have the same time stamp, so equal contents give identical archives.

use std::io::{Cursor, Read, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

use crate::error::{EmissionError, Result};

/// With this level instead of level 6, packing an FMU takes 0.58 s instead of 1.04 s, and the FMU is 2 % larger.
const COMPRESSION_LEVEL: i64 = 4;

/// Packs files, each a name and its content, into an archive.
///
/// # Errors
/// An archive does not support a name.
pub fn pack(files: Vec<(String, Vec<u8>)>) -> Result<Vec<u8>> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(COMPRESSION_LEVEL))
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

/// Largest size of an unpacked archive, in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// Returns names and contents of the files in an archive.
///
/// # Errors
/// The bytes are not an archive, or the archive is too large.
pub fn unpack(archive: &[u8]) -> Result<Vec<(String, Vec<u8>)>> {
    let failed =
        |error: &dyn std::fmt::Display| EmissionError::Request(format!("cannot unpack: {error}"));
    let mut archive = ZipArchive::new(Cursor::new(archive)).map_err(|error| failed(&error))?;
    let mut files = Vec::new();
    let mut rest = MAX_BYTES;
    for place in 0..archive.len() {
        let file = archive.by_index(place).map_err(|error| failed(&error))?;
        if file.is_dir() {
            continue;
        }
        let name = file.name().map_err(|error| failed(&error))?.into_owned();
        let mut contents = Vec::new();
        let length = file.take(rest).read_to_end(&mut contents);
        let length = length.map_err(|error| failed(&error))? as u64;
        rest -= length;
        if rest == 0 {
            return Err(failed(&"it is larger than 1 GiB"));
        }
        files.push((name, contents));
    }
    Ok(files)
}
