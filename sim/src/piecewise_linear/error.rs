//! Errors of exact propagation.

use std::fmt;

use eomgen_model_spec::argument::Argument;

use crate::ode::{Names, SolveError};

/// Reason why a motion cannot be propagated exactly; times in s.
#[derive(Clone, Debug, PartialEq)]
pub enum ExactError {
    /// The model is not piecewise linear.
    NotLinear {
        /// Term that is not piecewise linear.
        formula: String,
    },
    /// The model has constraints.
    Constrained,
    /// The model has impacts, at which rates jump.
    Impacts,
    /// The energies jump at a surface, so that rates jump there.
    Corners {
        /// Function that is zero on the surface.
        surface: String,
    },
    /// The model is invalid.
    Model(String),
    /// A coefficient is not finite.
    NotFinite,
    /// The mass matrix is not positive definite.
    NotPositiveDefinite,
    /// A dead zone has a negative half-width.
    NegativeHalfWidth,
    /// The eigenvalue iteration of a regime did not converge.
    NotConverged,
    /// A surface on which the rates are not linear holds the motion.
    Sticking {
        /// Time, s.
        t: f64,
        /// Index of the switching function.
        guard: usize,
    },
    /// An error that any solver can report.
    Stopped(SolveError),
}

impl ExactError {
    /// Returns the time reached, s; `None` if the simulation had not started.
    pub fn time(&self) -> Option<f64> {
        match self {
            Self::Sticking { t, .. } => Some(*t),
            Self::Stopped(error) => error.time(),
            _ => None,
        }
    }

    /// Returns the message: cause, time, state or surface, and remedy.
    pub fn format_named(&self, names: &Names<'_>) -> String {
        let cause = self.format_cause(names);
        let advantage = match self {
            Self::NotLinear { .. } => ", which supports any model",
            Self::Constrained | Self::Impacts | Self::Corners { .. } => "",
            Self::NotConverged => ", which needs no eigenvalues",
            _ => return cause,
        };
        let general = Argument::Solver.with_text("rk");
        format!("{cause}; use the general solver ({general}){advantage}")
    }

    /// Returns the cause with time and state or surface.
    pub fn format_cause(&self, names: &Names<'_>) -> String {
        match self {
            Self::NotLinear { formula } => {
                format!("the model is not piecewise linear, because of `{formula}`")
            }
            Self::Constrained => {
                "the model has constraints, which the exact solver does not support".to_owned()
            }
            Self::Impacts => {
                "the model has impacts, at which rates jump. The exact solver does not \
                              support them"
                    .to_owned()
            }
            Self::Corners { surface } => format!(
                "the energies of the model jump where `{surface}` is zero, so that rates jump there. The \
                 exact solver does not support this"
            ),
            Self::Model(message) => message.clone(),
            Self::NotFinite => "a coefficient of the equations of motion is not finite: check \
                 for a mass, inertia or length of zero, or a parameter that is far too large"
                .to_owned(),
            Self::NotPositiveDefinite => crate::ode::NOT_POSITIVE_DEFINITE_MESSAGE.to_owned(),
            Self::NegativeHalfWidth => {
                "the half-width of a dead zone is negative; expected 0 or more".to_owned()
            }
            Self::NotConverged => {
                "the eigenvalue iteration of the equations of motion did not converge".to_owned()
            }
            Self::Sticking { t, guard } => format!(
                "at t = {t:?} s the motion sticks on the switching surface on which {}, with forces that are not \
                 linear there, or moved by an input or the time; the exact solver supports sticking with a constant \
                 friction level and constant speeds only",
                names.surface_condition(*guard)
            ),
            Self::Stopped(error) => error.format_named(names),
        }
    }
}

impl fmt::Display for ExactError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.format_named(&Names::default()))
    }
}

impl std::error::Error for ExactError {}

impl From<SolveError> for ExactError {
    fn from(error: SolveError) -> Self {
        Self::Stopped(error)
    }
}
