//! Text of a specification file, with limits on its size.

use std::io::Read;
use std::path::Path;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::source::Source;
use crate::span::Span;

/// Largest specification read, in bytes.
pub const MAX_SIZE: u64 = 1 << 20;

/// Reads the text of a file. Messages contain the path `shown`.
pub(crate) fn read_text(file: &Path, shown: &str) -> Result<String, Diagnostics> {
    let bytes = read(file)
        .map_err(|diagnostic| Diagnostics::from_one(Source::new(shown, ""), diagnostic))?;
    String::from_utf8(bytes).map_err(|error| not_utf8(shown.to_owned(), &error))
}

fn read(path: &Path) -> Result<Vec<u8>, Diagnostic> {
    let unreadable = |error: std::io::Error| {
        Diagnostic::error(format!("the specification cannot be read: {error}"))
            .with_help("give the path of a TOML file")
    };
    let metadata = std::fs::metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        return Err(Diagnostic::error("the specification is not a file")
            .with_help("give the path of a TOML file"));
    }
    if metadata.len() > MAX_SIZE {
        return Err(too_large(metadata.len()));
    }
    let mut bytes = Vec::new();
    // The file may have grown since `metadata`; read at most one byte more than `check` accepts.
    let file = std::fs::File::open(path).map_err(unreadable)?;
    let read = file.take(MAX_SIZE + 1).read_to_end(&mut bytes);
    read.map_err(unreadable)?;
    Ok(bytes)
}

fn not_utf8(shown: String, error: &std::string::FromUtf8Error) -> Diagnostics {
    let valid = error.utf8_error().valid_up_to();
    let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
    let diagnostic = Diagnostic::error("the specification is not UTF-8 text")
        .with_span(Span::new(valid, valid + 1), "invalid byte")
        .with_help("save the file as UTF-8");
    Diagnostics::from_one(Source::new(shown, text), diagnostic)
}

pub(crate) fn too_large(size: u64) -> Diagnostic {
    Diagnostic::error(format!("the specification is too large: {size} bytes"))
        .with_span(Span::new(0, 0), "too large")
        .with_help(format!("reduce it to {MAX_SIZE} bytes (1 MiB)"))
}
