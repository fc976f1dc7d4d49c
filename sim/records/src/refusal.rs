//! Errors of dataset files and records.

use std::path::Path;

use eomgen_model_spec::diagnostic::Diagnostics;
use thiserror::Error;

/// Error of a dataset, with location, cause and remedy.
#[derive(Clone, Debug, Error)]
pub enum Refusal {
    /// Error in the dataset file.
    #[error(transparent)]
    Description(#[from] Diagnostics),
    #[error("{0}")]
    /// Error in a record: a sentence with its file, and with the line if known.
    Record(String),
}

impl Refusal {
    /// Creates an error about a whole record.
    pub fn file_error(path: &Path, message: impl std::fmt::Display) -> Self {
        Self::Record(format!("{}: {message}", path.display()))
    }

    /// Creates an error about a line of a record.
    pub fn line_error(path: &Path, line: u64, message: impl std::fmt::Display) -> Self {
        Self::Record(format!("{}, line {line}: {message}", path.display()))
    }
}
