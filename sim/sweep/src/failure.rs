//! What of a failed point is kept.

use eomgen_compiled_model::Error;
use eomgen_sim::ode::SolveError;
use eomgen_sim::piecewise_linear::ExactError;

use crate::measure::Failure;

impl From<Error> for Failure {
    /// What an instance refuses is wrong with its parameters.
    fn from(_: Error) -> Self {
        Self::Parameters
    }
}

impl From<SolveError> for Failure {
    fn from(error: SolveError) -> Self {
        match error {
            SolveError::NotFinite { .. } | SolveError::NotPositiveDefinite { .. } => {
                Self::NotFinite
            }
            SolveError::Caught { .. } | SolveError::TooManySwitches { .. } => Self::Switching,
            _ => Self::Limit,
        }
    }
}

impl From<ExactError> for Failure {
    fn from(error: ExactError) -> Self {
        match error {
            ExactError::Stopped(error) => error.into(),
            ExactError::Held { .. } => Self::Switching,
            ExactError::NotConverged => Self::Limit,
            ExactError::NotLinear { .. } => Self::Undefined,
            ExactError::Model(_)
            | ExactError::NotFinite
            | ExactError::NotPositiveDefinite
            | ExactError::NegativeHalfWidth => Self::Parameters,
        }
    }
}
