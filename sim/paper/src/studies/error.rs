//! Errors of studies.

use std::fmt;

use eomgen_analysis::AnalysisError;
use eomgen_compiled_model::Error;
use eomgen_sim::piecewise_linear::ExactError;

/// Reason for a failed study.
#[derive(Clone, Debug, PartialEq)]
pub enum StudyError {
    /// Invalid request, with the correction.
    Request(String),
    /// Failed simulation.
    Motion(ExactError),
    /// Failed analysis.
    Analysis(AnalysisError),
    /// File that could not be read or written, with the message of the system.
    File(String),
}

impl fmt::Display for StudyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Request(problem) | Self::File(problem) => f.write_str(problem),
            Self::Motion(error) => error.fmt(f),
            Self::Analysis(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for StudyError {}

impl From<ExactError> for StudyError {
    fn from(error: ExactError) -> Self {
        Self::Motion(error)
    }
}

impl From<Error> for StudyError {
    fn from(error: Error) -> Self {
        Self::Request(error.to_string())
    }
}

impl From<AnalysisError> for StudyError {
    fn from(error: AnalysisError) -> Self {
        Self::Analysis(error)
    }
}
