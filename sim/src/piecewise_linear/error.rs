//! Why a motion cannot be propagated exactly.

use std::fmt;

use crate::ode::{Names, SolveError};

/// Why a motion cannot be propagated exactly; times in s.
#[derive(Clone, Debug, PartialEq)]
pub enum ExactError {
    /// The model is not linear between its switching surfaces.
    NotLinear {
        /// The term in the way.
        formula: String,
    },
    /// The model has constraints.
    Constrained,
    /// Rates jump at impacts.
    Impacts,
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

impl ExactError {
    /// Where the motion stands, s, if it had begun.
    pub fn time(&self) -> Option<f64> {
        match self {
            Self::Held { t, .. } => Some(*t),
            Self::Stopped(error) => error.time(),
            _ => None,
        }
    }

    /// What is wrong, when, with which quantity, and what to do.
    pub fn named(&self, names: &Names<'_>) -> String {
        match self {
            Self::NotLinear { formula } => format!(
                "the model is not linear between its switches: `{formula}`; the general solver \
                 (--solver rk) takes any model"
            ),
            Self::Constrained => {
                "the model has constraints, which the exact solver does not solve \
                 for; the general solver (--solver rk) does"
                    .to_owned()
            }
            Self::Impacts => "the model has impacts, at which rates jump, and the exact solver \
                 does not stop there; the general solver (--solver rk) does"
                .to_owned(),
            Self::Model(message) => message.clone(),
            Self::NotFinite => "a coefficient of the equations of motion is infinite or not a \
                 number: a mass, inertia or length is zero, or a parameter far too large"
                .to_owned(),
            Self::NotPositiveDefinite => crate::ode::NOT_POSITIVE.to_owned(),
            Self::NegativeHalfWidth => {
                "the half-width of a dead zone is negative: expected 0 or more".to_owned()
            }
            Self::NotConverged => "the eigenvalues of the equations of motion could not be \
                 found; the general solver (--solver rk) needs none"
                .to_owned(),
            Self::Held { t, guard } => format!(
                "at t = {t:?} s the motion is held where {}, by forces that are not linear \
                 there; the exact solver knows friction whose level is constant",
                names.surface(*guard)
            ),
            Self::Stopped(error) => error.named(names),
        }
    }
}

impl fmt::Display for ExactError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.named(&Names::default()))
    }
}

impl std::error::Error for ExactError {}

impl From<SolveError> for ExactError {
    fn from(error: SolveError) -> Self {
        Self::Stopped(error)
    }
}
