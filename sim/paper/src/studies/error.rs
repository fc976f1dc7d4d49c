//! Why a study could not be made.

use std::fmt;

use eomgen_analysis::AnalysisError;
use eomgen_compiled_model::Error;
use eomgen_sim::piecewise_linear::ExactError;

/// Why a study could not be made.
#[derive(Clone, Debug, PartialEq)]
pub enum StudyError {
    /// The request makes no sense: what is wrong and what would be right.
    Request(String),
    /// The motion could not be propagated.
    Motion(ExactError),
    /// The motion could not be analysed.
    Analysis(AnalysisError),
    /// A file could not be read or written: which, and what the system says.
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
