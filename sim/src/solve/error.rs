//! Why a simulation could not be finished.

use std::fmt;

/// Why a simulation could not be finished; times in s.
#[derive(Clone, Debug, PartialEq)]
pub enum SolveError {
    /// The request makes no sense.
    Request {
        /// What is wrong with it and what would be right.
        problem: String,
    },
    /// A rate is infinite or not a number.
    NotFinite {
        /// When.
        t: f64,
        /// The index of the state variable.
        state: usize,
    },
    /// No step is short enough for the tolerance.
    StepTooSmall {
        /// Where the solver stands.
        t: f64,
        /// The step that was refused, s.
        step: f64,
    },
    /// The limit on steps is reached.
    TooManySteps {
        /// Where the solver stands.
        t: f64,
        /// The limit.
        steps: u64,
    },
    /// The motion is held on a switching surface: the rates lead onto it from both sides.
    Caught {
        /// Where the solver stands.
        t: f64,
        /// The index of the switching function.
        guard: usize,
    },
    /// Switching surfaces are crossed too fast.
    TooManySwitches {
        /// Where the solver stands.
        t: f64,
        /// The index of the switching function crossed last.
        guard: usize,
        /// The limit, 1/s.
        rate: f64,
    },
}

impl fmt::Display for SolveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Request { problem } => write!(f, "{problem}"),
            Self::NotFinite { t, state } => write!(
                f,
                "at t = {t:?} s the rate of state variable {state} is infinite or not a number"
            ),
            Self::StepTooSmall { t, step } => write!(
                f,
                "at t = {t:?} s no step meets the tolerance (last tried: {step:e} s): the model is \
                 singular or far too stiff there; check the parameters or loosen the tolerance"
            ),
            Self::TooManySteps { t, steps } => write!(
                f,
                "stopped at t = {t:?} s after {steps} steps: the model is stiff or moves fast there; \
                 loosen the tolerance or shorten the time"
            ),
            Self::Caught { t, guard } => write!(
                f,
                "at t = {t:?} s the motion is held where switching function {guard} is zero, as \
                 dry friction holds a body at rest; replace the jump there by a steep smooth \
                 function, sign(v) by tanh(v/v_0) say"
            ),
            Self::TooManySwitches { t, guard, rate } => write!(
                f,
                "at t = {t:?} s switching function {guard} changes its sign more than {rate:e} \
                 times a second; replace the kink there by a smooth function"
            ),
        }
    }
}

impl std::error::Error for SolveError {}
