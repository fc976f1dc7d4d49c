//! Conversion of errors at a point into the status of the point.

use eomgen_compiled_model::{Error, Motion, StopCause};
use eomgen_sim::ode::SolveError;
use eomgen_sim::piecewise_linear::ExactError;
use eomgen_sim::variational::GrowthError;

use crate::measure::Failure;

impl From<Error> for Failure {
    /// The only errors of an instance are inadmissible parameters.
    fn from(_: Error) -> Self {
        Self::Parameters
    }
}

pub fn require_finished_motion(motion: Result<Motion, Error>) -> Result<Motion, Failure> {
    let motion = motion.map_err(|error| match error {
        // The motion has stopped at its start.
        Error::Stopped { .. } => Failure::NotFinite,
        error => error.into(),
    })?;
    match motion.early_stop.as_ref().map(|stopped| &stopped.cause) {
        None => Ok(motion),
        Some(StopCause::NotFinite) => Err(Failure::NotFinite),
        Some(StopCause::Switching) => Err(Failure::Switching),
        Some(StopCause::Stiff(_) | StopCause::Limit) => Err(Failure::Limit),
    }
}

impl From<SolveError> for Failure {
    fn from(error: SolveError) -> Self {
        match error {
            SolveError::NotFinite { .. } | SolveError::NotPositiveDefinite { .. } => {
                Self::NotFinite
            }
            SolveError::Sticking { .. } | SolveError::TooManySwitches { .. } => Self::Switching,
            _ => Self::Limit,
        }
    }
}

impl From<ExactError> for Failure {
    fn from(error: ExactError) -> Self {
        match error {
            ExactError::Stopped(error) => error.into(),
            ExactError::Sticking { .. } => Self::Switching,
            ExactError::NotConverged => Self::Limit,
            ExactError::NotLinear { .. }
            | ExactError::Constrained
            | ExactError::Impacts
            | ExactError::Corners { .. } => Self::Undefined,
            ExactError::Model(_)
            | ExactError::NotFinite
            | ExactError::NotPositiveDefinite
            | ExactError::NegativeHalfWidth => Self::Parameters,
        }
    }
}

impl From<GrowthError> for Failure {
    fn from(error: GrowthError) -> Self {
        match error {
            GrowthError::Motion(error) => error.into(),
            GrowthError::SimultaneousCrossing(_) => Self::Switching,
            GrowthError::NoLength => Self::Undefined,
        }
    }
}
