//! Reads text files in the folder of a specification or below it, up to a size limit.

use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// Largest file read, in bytes.
const MAX_SIZE: u64 = 8 << 20;

/// Cause of the error, worded to follow the file name in a sentence, and a proposed correction.
pub struct FileError(pub String, pub &'static str);

/// Reads the file with this name.
///
/// # Errors
/// The name is outside the folder, or the file cannot be read, is too large or is not UTF-8.
pub fn read(folder: &Path, name: &str) -> Result<String, FileError> {
    let bytes = bytes(&resolve_path(folder, name)?)?;
    match text(&bytes) {
        Ok(text) => Ok(text.to_owned()),
        Err(line) => Err(FileError(
            format!("is not UTF-8 text: line {line}"),
            "save the file as UTF-8",
        )),
    }
}

/// Returns the path of a name. Symbolic links are followed before the folder is checked.
fn resolve_path(folder: &Path, name: &str) -> Result<PathBuf, FileError> {
    let relative = Path::new(name);
    let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let place = folder.join(relative);
    // A missing file is reported by the caller.
    let leads_out = match (place.canonicalize(), folder.canonicalize()) {
        (Ok(place), Ok(folder)) => !place.starts_with(folder),
        _ => false,
    };
    if name.is_empty() || leads_out || !relative.components().all(inside) {
        return Err(FileError(
            "is outside the specification's folder".to_owned(),
            "move the file into the folder of the specification or a subfolder",
        ));
    }
    Ok(place)
}

fn bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    let help = "give the path of a file, relative to the specification";
    let unreadable = |error: std::io::Error| FileError(format!("cannot be read: {error}"), help);
    let too_large = || {
        let limit = MAX_SIZE >> 20;
        FileError(format!("is larger than {limit} MiB"), "give a smaller file")
    };
    let metadata = std::fs::metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        return Err(FileError("is not a file".to_owned(), help));
    }
    if metadata.len() > MAX_SIZE {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(unreadable)?;
    // The file may have grown since `metadata`.
    let read = file.take(MAX_SIZE + 1).read_to_end(&mut bytes);
    read.map_err(unreadable)?;
    if bytes.len() as u64 > MAX_SIZE {
        return Err(too_large());
    }
    Ok(bytes)
}

/// Returns the text, or the line of the first byte that is not UTF-8. A zero byte counts as an
/// error: it indicates UTF-16.
fn text(bytes: &[u8]) -> Result<&str, usize> {
    let line = |valid: &[u8]| valid.iter().filter(|byte| **byte == b'\n').count() + 1;
    let text = std::str::from_utf8(bytes).map_err(|error| line(&bytes[..error.valid_up_to()]))?;
    match text.find('\0') {
        Some(zero) => Err(line(&bytes[..zero])),
        None => Ok(text),
    }
}
