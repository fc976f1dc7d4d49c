//! Errors of dataset files and records.

use std::path::Path;

use eomgen_model_spec::diagnostic::Diagnostics;

/// Error of a dataset: place, cause and cure.
#[derive(Clone, Debug)]
pub enum Refusal {
    /// Error in the dataset file.
    Description(Diagnostics),
    /// Error in a record: a sentence with its file, and with the line if there is one.
    Record(String),
}

impl Refusal {
    /// Creates an error of a whole record.
    pub fn file_error(path: &Path, message: impl std::fmt::Display) -> Self {
        Self::Record(format!("{}: {message}", path.display()))
    }

    /// Creates an error in a line of a record.
    pub fn line_error(path: &Path, line: u64, message: impl std::fmt::Display) -> Self {
        Self::Record(format!("{}, line {line}: {message}", path.display()))
    }
}

impl From<Diagnostics> for Refusal {
    fn from(found: Diagnostics) -> Self {
        Self::Description(found)
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Description(found) => found.fmt(f),
            Self::Record(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for Refusal {}
