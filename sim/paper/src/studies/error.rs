//! Errors of studies.

use eomgen_analysis::AnalysisError;
use eomgen_compiled_model::Error;
use eomgen_sim::piecewise_linear::ExactError;

/// Reason for a failed study.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// Invalid request, with its remedy.
    #[error("{0}")]
    Request(String),
    /// Failed simulation.
    #[error(transparent)]
    Motion(#[from] ExactError),
    /// Failed analysis.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    #[error("{0}")]
    /// File that could not be read or written, with the message of the operating system.
    File(String),
}

impl From<Error> for StudyError {
    fn from(error: Error) -> Self {
        Self::Request(error.to_string())
    }
}
