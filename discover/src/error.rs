//! Why nothing could be compared or searched.

use crate::ids::WindowId;
use std::fmt;

use eomgen_compiled_model::Error as ModelError;
use eomgen_model_spec::edit::EditError;
use eomgen_records::Refusal;
use eomgen_records::windows::Windows;
use eomgen_sim::ode::SolveError;
use eomgen_sim::piecewise_linear::ExactError;

/// What is said where somebody asked to stop.
const STOPPED: &str = "stopped as asked";

/// What can go wrong on the way from a specification and records to a result.
#[derive(Clone, Debug)]
pub enum DiscoverError {
    /// A specification that does not check or cannot be derived.
    Model(Box<ModelError>),
    /// An edit that a specification does not admit.
    Edit(Box<EditError>),
    /// A user's effect that does not leave a specification.
    Effect {
        /// The effect.
        effect: String,
        /// The place it was written to.
        on: String,
        /// What was wrong.
        error: Box<EditError>,
    },
    /// Records, or their labels, that are refused.
    Records(Box<Refusal>),
    /// Initial states are to be read from the record, and no channel shows this state.
    StateNotMeasured(String),
    /// No motion can be followed: where, and what is expected.
    Unfollowed(Unfollowed),
    /// No motion of a candidate's own model can be followed.
    CandidateUnfollowed,
    /// A candidate that changes no output.
    NotExcited,
    /// Somebody asked to stop.
    Stopped,
}

/// The windows through which a model's motion cannot be followed.
#[derive(Clone, Debug, PartialEq)]
pub struct Unfollowed {
    /// How many there are.
    pub count: usize,
    /// Of how many.
    pub of: usize,
    /// When the first begins, s.
    pub first: f64,
    /// The record in which that is.
    pub record: String,
}

impl Unfollowed {
    /// Some of all windows; none if there are none.
    pub fn of(windows: &Windows<'_>, unfollowed: &[WindowId]) -> Option<Self> {
        let window = &windows.list[*unfollowed.first()?];
        Some(Self {
            count: unfollowed.len(),
            of: windows.list.len(),
            first: window.times[0],
            record: windows.records[window.record].name.clone(),
        })
    }
}

/// Why a model's motion cannot be followed.
#[derive(Clone, Debug, PartialEq)]
pub enum SimulationError {
    /// At these parameters the mass matrix is not positive definite.
    MassMatrix,
    /// The exact propagator does not take the part that is linear between switches.
    Propagator(ExactError),
    /// The exponential integrator stopped, and why.
    Integrator(String),
    /// The solver with error control stopped.
    Solver(SolveError),
    /// A part of it moves too fast beside the samples.
    TooFast,
    /// The motion grows beyond all bounds.
    Unbounded,
    /// The records give the motion, but not that of all states.
    NotGiven,
    /// Somebody asked to stop.
    Stopped,
}

impl fmt::Display for SimulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MassMatrix => f.write_str("the mass matrix is not positive definite"),
            Self::Propagator(error) => error.fmt(f),
            Self::Integrator(reason) => f.write_str(reason),
            Self::Solver(error) => error.fmt(f),
            Self::NotGiven => f.write_str("the records do not give the motion of all its states"),
            Self::TooFast => {
                f.write_str("a part of it moves far too fast to be seen in the samples")
            }
            Self::Unbounded => f.write_str("the motion grows beyond all bounds"),
            Self::Stopped => f.write_str(STOPPED),
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
            Self::Effect { effect, on, error } => write!(
                f,
                "the effect `{effect}` on `{on}` does not leave a specification: {error}"
            ),
            Self::Records(refusal) => refusal.fmt(f),
            Self::StateNotMeasured(state) => write!(
                f,
                "windows.start = \"smoothed\" needs a channel for every coordinate and state of first order, and none shows \
                 `{state}`; expected start = \"fitted\""
            ),
            Self::Unfollowed(windows) => write!(
                f,
                "the model's motion cannot be followed in {} of {} windows, first at t = {:.6} s of \
                 {}: nothing can be compared there; expected a model that runs through its records",
                windows.count, windows.of, windows.first, windows.record
            ),
            Self::CandidateUnfollowed => f.write_str("the motion with it cannot be followed"),
            Self::NotExcited => {
                f.write_str("nothing in the record would show it: it does not change the outputs")
            }
            Self::Stopped => f.write_str(STOPPED),
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
