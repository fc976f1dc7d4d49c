//! Errors of dataset files and records.

use std::path::Path;

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quote};
use eomgen_model_spec::source::Source;
use eomgen_model_spec::span::Span;
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
    /// Column that a record does not have.
    #[error(transparent)]
    Column(MissingColumn),
}

/// Column of a dataset file that a record does not have.
#[derive(Clone, Debug, Error)]
#[error("{message}")]
pub struct MissingColumn {
    /// Sentence with the record and the line of the names.
    pub message: String,
    /// Location of the column's name or number in the dataset file.
    pub span: Span,
    /// Nearest name of a column in the record.
    pub nearest: Option<String>,
}

impl MissingColumn {
    /// Returns the error with its location in the dataset file.
    pub fn locate(self, source: &Source) -> Refusal {
        let help = self
            .nearest
            .map(|name| format!("did you mean {}?", quote(&name)));
        let diagnostic = Diagnostic::error(self.message)
            .with_span(self.span, "expected a column of the record")
            .with_optional_help(help);
        Diagnostics::from_one(source.clone(), diagnostic).into()
    }
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

    /// Creates an error about a column that a record does not have. `line`: line of the names.
    pub fn column_error(
        path: &Path,
        line: u64,
        span: Span,
        message: impl std::fmt::Display,
        nearest: Option<&str>,
    ) -> Self {
        Self::Column(MissingColumn {
            message: format!("{}, line {line}: {message}", path.display()),
            span,
            nearest: nearest.map(str::to_owned),
        })
    }

    /// Adds the location in the dataset file to an error about a column.
    pub fn locate_column(self, source: &Source) -> Self {
        match self {
            Self::Column(missing) => missing.locate(source),
            other => other,
        }
    }
}
