//! Errors of the comparison and of the search.

use crate::ids::WindowId;
use std::fmt;

use eomgen_compiled_model::Error as ModelError;
use eomgen_model_spec::edit::EditError;
use eomgen_records::Refusal;
use eomgen_records::windows::Windows;
use eomgen_sim::ode::SolveError;
use eomgen_sim::piecewise_linear::ExactError;

/// Message after a stop on request.
const STOPPED: &str = "stopped on request";

/// Message if the limit on work is reached.
const TOO_MUCH_WORK: &str = "the limit on evaluations of the rates is reached";

/// Error of a comparison or search.
#[derive(Clone, Debug)]
pub enum DiscoverError {
    /// The specification is invalid or its equations cannot be derived.
    Model(Box<ModelError>),
    /// An edit of the specification is impossible.
    Edit(Box<EditError>),
    /// A user-defined effect makes the specification invalid.
    Effect {
        /// Name of the effect.
        effect: String,
        /// Site of the effect.
        site: String,
        /// Error of the edit.
        error: Box<EditError>,
    },
    /// The records or their labels are rejected.
    Records(Box<Refusal>),
    /// Initial states must be read from the record, but no channel measures this state.
    StateNotMeasured(String),
    /// No motion can be simulated in some windows.
    SimulationFailed(FailedWindows),
    /// The motion of a candidate's model cannot be simulated.
    CandidateSimulationFailed,
    /// The candidate does not change any output.
    NotExcited,
    /// Stop was requested.
    Stopped,
    /// A fit needs more evaluations of the rates than this limit.
    TooMuchWork(u64),
}

/// Windows in which the motion of a model cannot be simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct FailedWindows {
    /// Number of failed windows.
    pub count: usize,
    /// Number of all windows.
    pub total: usize,
    /// Start of the first failed window, s.
    pub first_start: f64,
    /// Path of the record that contains the first failed window.
    pub record: String,
}

impl FailedWindows {
    /// Summarises failed windows; `None` if there are none.
    pub fn from_windows(windows: &Windows<'_>, unfollowed: &[WindowId]) -> Option<Self> {
        let window = &windows.windows[*unfollowed.first()?];
        Some(Self {
            count: unfollowed.len(),
            total: windows.windows.len(),
            first_start: windows.records[window.record].origin + window.times[0],
            record: windows.records[window.record].name.clone(),
        })
    }
}

/// Reason why the motion of a model cannot be simulated.
#[derive(Clone, Debug, PartialEq)]
pub enum SimulationError {
    /// The mass matrix is not positive definite at these parameters.
    IndefiniteMassMatrix,
    /// The exact propagator rejects the linear part of the model.
    Propagator(ExactError),
    /// The exponential integrator failed for the given reason.
    Integrator(String),
    /// The solver with error control failed.
    Solver(SolveError),
    /// A part of the motion is too fast for the sampling.
    TooFast,
    /// The state diverged.
    Diverged,
    /// No state near the motion satisfies the constraints.
    OffConstraints,
    /// The motion is given by the records, which do not contain all states.
    StateNotRecorded,
    /// Stop was requested.
    Stopped,
    /// The limit on work is reached.
    TooMuchWork,
}

impl fmt::Display for SimulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::IndefiniteMassMatrix => f.write_str("the mass matrix is not positive definite"),
            Self::Propagator(error) => error.fmt(f),
            Self::Integrator(reason) => f.write_str(reason),
            Self::Solver(error) => error.fmt(f),
            Self::StateNotRecorded => {
                f.write_str("the records do not give the motion of all states")
            }
            Self::TooFast => {
                f.write_str("a part of the motion is too fast for the sampling rate of the records")
            }
            Self::Diverged => f.write_str(
                "the state diverged, or a function left its domain (for example sqrt \
             of a negative number)",
            ),
            Self::OffConstraints => {
                f.write_str("no state near the motion satisfies the constraints of the model")
            }
            Self::Stopped => f.write_str(STOPPED),
            Self::TooMuchWork => f.write_str(TOO_MUCH_WORK),
        }
    }
}

impl std::error::Error for SimulationError {}

impl fmt::Display for DiscoverError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model(error) => match &**error {
                ModelError::Specification(found) => f.write_str(&found.render(false)),
                other => other.fmt(f),
            },
            Self::Edit(error) => error.fmt(f),
            Self::Effect {
                effect,
                site: on,
                error,
            } => write!(
                f,
                "the effect `{effect}` on `{on}` makes the specification invalid: {error}"
            ),
            Self::Records(refusal) => refusal.fmt(f),
            Self::StateNotMeasured(state) => write!(
                f,
                "windows.start = \"smoothed\" needs a channel for every coordinate and first-order state, and \
                 none measures `{state}`; expected start = \"fitted\""
            ),
            Self::SimulationFailed(windows) => write!(
                f,
                "the simulation of the model fails in {} of {} windows, first at t = {:.6} s of {}; expected a \
                 model that can be simulated on its records",
                windows.count, windows.total, windows.first_start, windows.record
            ),
            Self::CandidateSimulationFailed => f.write_str("the simulation with this effect fails"),
            Self::NotExcited => {
                f.write_str("the records cannot show it, because it does not change the outputs")
            }
            Self::Stopped => f.write_str(STOPPED),
            Self::TooMuchWork(most) => write!(
                f,
                "its fit needs more than {most:.1e} evaluations of the rates, which is the limit for these records"
            ),
        }
    }
}

impl std::error::Error for DiscoverError {}

impl From<ModelError> for DiscoverError {
    fn from(error: ModelError) -> Self {
        Self::Model(Box::new(error))
    }
}

impl From<EditError> for DiscoverError {
    fn from(error: EditError) -> Self {
        Self::Edit(Box::new(error))
    }
}

impl From<Refusal> for DiscoverError {
    fn from(refusal: Refusal) -> Self {
        Self::Records(Box::new(refusal))
    }
}
