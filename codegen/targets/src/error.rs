//! Errors of the emission of files.

use std::fmt::Display;

use eomgen_model_spec::diagnostic::Diagnostics;
use thiserror::Error;

pub type Result<T, E = EmissionError> = std::result::Result<T, E>;

/// Reason why no files are emitted.
#[derive(Clone, Debug, Error)]
pub enum EmissionError {
    /// Unsupported combination of model, target and outputs, with a proposed correction.
    #[error("{0}")]
    Request(String),
    /// Invalid values of the specification.
    #[error("{0}")]
    Specification(Diagnostics),
}

impl EmissionError {
    pub(crate) fn request(reason: impl Display) -> Self {
        Self::Request(reason.to_string())
    }
}
