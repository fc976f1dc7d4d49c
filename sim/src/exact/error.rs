//! Why a motion cannot be propagated exactly.

use std::fmt;

use crate::solve::SolveError;

/// Why a motion cannot be propagated exactly; times in s.
#[derive(Clone, Debug, PartialEq)]
pub enum ExactError {
    /// The model is not linear between its switching surfaces.
    NotLinear {
        /// The term in the way.
        formula: String,
    },
    /// The model itself is at fault.
    Model(String),
    /// A coefficient is infinite or not a number.
    NotFinite,
    /// The mass matrix is not positive definite.
    NotPositiveDefinite,
    /// A dead zone has a negative half-width.
    NegativeHalfWidth,
    /// The eigenvalues of a regime could not be found.
    NotConverged,
    /// The motion is held on a switching surface by rates that are not linear there.
    Held {
        /// When.
        t: f64,
        /// The index of the switching function.
        guard: usize,
    },
    /// Stopped for a reason that any solver may have.
    Stopped(SolveError),
}

impl fmt::Display for ExactError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotLinear { formula } => write!(
                f,
                "the model is not linear between its switches: `{formula}`; the general solver \
                 (--solver rk) takes any model"
            ),
            Self::Model(message) => f.write_str(message),
            Self::NotFinite => f.write_str(
                "a coefficient of the equations of motion is infinite or not a number: a mass, \
                 inertia or length is zero, or a parameter far too large",
            ),
            Self::NotPositiveDefinite => f.write_str(crate::derived::NOT_POSITIVE),
            Self::NegativeHalfWidth => {
                f.write_str("the half-width of a dead zone is negative: expected 0 or more")
            }
            Self::NotConverged => f.write_str(
                "the eigenvalues of the equations of motion could not be found; the general \
                 solver (--solver rk) needs none",
            ),
            Self::Held { t, guard } => write!(
                f,
                "at t = {t:?} s the motion is held where switching function {guard} is zero, by \
                 forces that are not linear there; the exact solver knows friction whose level \
                 is constant"
            ),
            Self::Stopped(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ExactError {}

impl From<SolveError> for ExactError {
    fn from(error: SolveError) -> Self {
        Self::Stopped(error)
    }
}
