//! Why there is no model, no instance of it or no motion.

use std::fmt;

use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::variant::ModelError;
use eomgen_sim::piecewise_linear::ExactError;

/// What keeps a model from being compiled or run.
#[derive(Clone, Debug)]
pub enum Error {
    /// The specification, or a parameter value set in it, is wrong: where, why, what would be
    /// right.
    Specification(Diagnostics),
    /// The solver that was asked for does not take the model, or the request makes no sense.
    Request(String),
    /// The motion could not be followed: what is wrong, with names, and what to do.
    Stopped {
        /// Where the motion stands, s, if it had begun.
        t: Option<f64>,
        /// What is wrong.
        reason: String,
    },
}

impl Error {
    /// What is wrong with a model as such.
    pub(crate) fn model(model: &Model, error: ModelError) -> Self {
        Self::Specification(Diagnostics::one(model.source.clone(), error.diagnostic()))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Specification(found) => found.fmt(f),
            Self::Request(reason) | Self::Stopped { reason, .. } => f.write_str(reason),
        }
    }
}

impl std::error::Error for Error {}

impl From<Diagnostics> for Error {
    fn from(found: Diagnostics) -> Self {
        Self::Specification(found)
    }
}

impl From<&ExactError> for Error {
    fn from(error: &ExactError) -> Self {
        Self::Request(error.to_string())
    }
}
