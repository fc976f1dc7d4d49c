//! Errors of compiling and running a model.

#[cfg(feature = "derive")]
use eomgen_model_spec::diagnostic::Diagnostics;
#[cfg(feature = "derive")]
use eomgen_model_spec::model::Model;
#[cfg(feature = "derive")]
use eomgen_model_spec::variant::ModelError;
#[cfg(feature = "derive")]
use eomgen_sim::piecewise_linear::ExactError;

/// Reason why a model cannot be compiled or run.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Error {
    #[cfg(feature = "derive")]
    #[error(transparent)]
    /// Errors of the specification or of a parameter value, each with its location and remedy.
    Specification(#[from] Diagnostics),
    #[error("{0}")]
    /// A solver that does not support the model, or an invalid request.
    Request(String),
    #[error("{reason}")]
    /// Simulation or search that stopped early, with cause and remedy.
    Stopped {
        /// Current time, s; `None` if the simulation had not started.
        t: Option<f64>,
        /// Cause, with the names of the states or surfaces involved.
        reason: String,
    },
}

#[cfg(feature = "derive")]
impl Error {
    /// Converts an error of the model into an error at its location in the specification.
    pub(crate) fn from_model_error(model: &Model, error: ModelError) -> Self {
        Self::Specification(Diagnostics::from_one(
            model.source.clone(),
            error.diagnostic(),
        ))
    }
}

#[cfg(feature = "derive")]
impl From<&ExactError> for Error {
    fn from(error: &ExactError) -> Self {
        Self::Request(error.to_string())
    }
}
