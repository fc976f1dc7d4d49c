//! Causes of early stops, with the names of states and surfaces.

use eomgen_sim::ode::{Names, SolveError, Surface, UnsupportedSticking};
#[cfg(feature = "derive")]
use eomgen_sim::piecewise_linear::ExactError;

use crate::labels::Labels;
use crate::motion::{Solver, StopCause};

/// Returns the category of an error of a general solver.
pub(crate) fn find_stop_cause(
    labels: &Labels,
    error: &SolveError,
    surfaces: &[Surface],
) -> StopCause {
    match error {
        SolveError::NotFinite { .. } | SolveError::NotPositiveDefinite { .. } => {
            StopCause::NotFinite
        }
        SolveError::Sticking { .. } | SolveError::TooManySwitches { .. } => StopCause::Switching,
        SolveError::Stiff { state, within, .. } => {
            let state = &labels.state_names[*state];
            StopCause::Stiff(format!(
                "the model is stiff: `{state}` settles within {within:.1e} s"
            ))
        }
        SolveError::StiffAtSurface { guard, .. } => StopCause::Stiff(match surfaces.get(*guard) {
            Some(surface) => {
                format!(
                    "the model is stiff near the surface where `{}` is zero",
                    surface.formula
                )
            }
            None => "the model is stiff near a switching surface".to_owned(),
        }),
        SolveError::Request { .. }
        | SolveError::StepTooSmall { .. }
        | SolveError::TooManySteps { .. } => StopCause::Limit,
    }
}

/// Returns the category of an error of the exact solver.
#[cfg(feature = "derive")]
pub(crate) fn find_exact_stop_cause(
    labels: &Labels,
    error: &ExactError,
    surfaces: &[Surface],
) -> StopCause {
    match error {
        ExactError::Stopped(error) => find_stop_cause(labels, error, surfaces),
        ExactError::Sticking { .. } => StopCause::Switching,
        ExactError::NotFinite | ExactError::NotPositiveDefinite => StopCause::NotFinite,
        _ => StopCause::Limit,
    }
}

/// Returns cause and remedy of an error of the exact solver.
#[cfg(feature = "derive")]
pub(crate) fn describe_exact_stop(
    labels: &Labels,
    surfaces: &[Surface],
    error: &ExactError,
) -> String {
    format_named(labels, (surfaces, Solver::Exact), |names| {
        error.format_named(names)
    })
}

/// Returns true if another solver may support the motion.
#[cfg(feature = "derive")]
pub(crate) fn may_be_supported_by_general(error: &ExactError) -> bool {
    match error {
        ExactError::Sticking { .. } | ExactError::NotConverged => true,
        ExactError::Stopped(error) => !matches!(
            error,
            SolveError::Request { .. }
                | SolveError::NotFinite { .. }
                | SolveError::NotPositiveDefinite { .. }
        ),
        _ => false,
    }
}

/// Formats an error of a solver with the names of the states and switching functions.
pub(crate) fn format_named(
    labels: &Labels,
    (surfaces, solver): (&[Surface], Solver),
    message: impl FnOnce(&Names<'_>) -> String,
) -> String {
    let unsupported_sticking = match solver {
        Solver::Adams => UnsupportedSticking::Adams,
        Solver::Exact => UnsupportedSticking::Exact,
        _ => UnsupportedSticking::Formula,
    };
    message(&Names {
        states: &labels.state_names,
        surfaces,
        unsupported_sticking,
    })
}
