//! Why a simulation could not be finished.

use std::fmt;

use super::names::Names;

/// What is said where the mass matrix is not positive definite.
pub const NOT_POSITIVE: &str =
    "the mass matrix is not positive definite: a mass, inertia or length is zero or negative";

/// Why a simulation could not be finished; times in s.
#[derive(Clone, Debug, PartialEq)]
pub enum SolveError {
    /// The request makes no sense.
    Request {
        /// What is wrong with it and what would be right.
        problem: String,
    },
    /// A rate is infinite or not a number there, or after the shortest step from there.
    NotFinite {
        /// When.
        t: f64,
        /// The index of the state variable.
        state: usize,
    },
    /// The mass matrix is not positive definite, or the motion leads to where it is not.
    NotPositiveDefinite {
        /// When.
        t: f64,
        /// The index of the coordinate whose inertia, given those before it, is not positive.
        coordinate: usize,
    },
    /// No step is short enough for the tolerance.
    StepTooSmall {
        /// Where the solver stands.
        t: f64,
        /// The step that was refused, s.
        step: f64,
        /// The index of the state variable that changes fastest there, in parts of its size.
        state: usize,
    },
    /// The system is stiff: what decays fastest keeps the steps so short that there would be no
    /// end within the limit on steps.
    Stiff {
        /// Where the solver stands.
        t: f64,
        /// The index of the state variable that decays fastest.
        state: usize,
        /// How long that takes, s.
        within: f64,
        /// How many more steps there would be.
        steps: f64,
    },
    /// The limit on steps is reached.
    TooManySteps {
        /// Where the solver stands.
        t: f64,
        /// The limit.
        steps: u64,
        /// The index of the state variable that changes fastest there, in parts of its size.
        state: usize,
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

impl SolveError {
    /// Where the solver stands, s; nothing if it has not begun.
    pub fn time(&self) -> Option<f64> {
        match *self {
            Self::Request { .. } => None,
            Self::NotFinite { t, .. }
            | Self::NotPositiveDefinite { t, .. }
            | Self::StepTooSmall { t, .. }
            | Self::Stiff { t, .. }
            | Self::TooManySteps { t, .. }
            | Self::Caught { t, .. }
            | Self::TooManySwitches { t, .. } => Some(t),
        }
    }

    /// What is wrong, when, with which quantity, and what to do.
    pub fn named(&self, names: &Names<'_>) -> String {
        match self {
            Self::Request { problem } => problem.clone(),
            Self::NotFinite { t, state } => format!(
                "the state diverged at t = {t:?} s, or a function left its domain (for example sqrt \
                 of a negative number) in the rate of {}; check the parameters and the initial \
                 state, keep the function in its domain (as sqrt(max(x, 0)) does), or shorten the \
                 time",
                names.state(*state)
            ),
            Self::NotPositiveDefinite { t, coordinate } => format!(
                "at t = {t:?} s the mass matrix is not positive definite: the inertia of {} is \
                 zero or negative there, and no acceleration follows; check what the kinetic \
                 energy is in that position",
                names.state(*coordinate)
            ),
            Self::StepTooSmall { t, step, state } => format!(
                "at t = {t:?} s no step meets the tolerance (last tried: {step:e} s): {} changes \
                 too fast there. The state diverges, or its rate is singular; check the \
                 parameters, loosen the tolerance, or shorten the time",
                names.state(*state)
            ),
            Self::Stiff {
                t,
                state,
                within,
                steps,
            } => format!(
                "stopped at t = {t:?} s: the model is stiff. {} settles within {within:.1e} s, \
                 which keeps the steps of an explicit solver so short that {steps:.1e} more of \
                 them were needed; take the solver radau, which is implicit, or soften what makes \
                 it settle (a stiff spring or damper, a smooth friction that is too steep)",
                names.state(*state)
            ),
            Self::TooManySteps { t, steps, state } => format!(
                "stopped at t = {t:?} s after {steps} steps: {} moves too fast there for so long \
                 a time; loosen the tolerance or shorten the time",
                names.state(*state)
            ),
            Self::Caught { t, guard } => format!(
                "at t = {t:?} s the motion is held where {}: {}",
                names.surface(*guard),
                names.held(*guard)
            ),
            Self::TooManySwitches { t, guard, rate } => format!(
                "at t = {t:?} s the motion crosses the place where {} more than {rate:e} times a \
                 second: {}",
                names.surface(*guard),
                names.held(*guard)
            ),
        }
    }
}

impl fmt::Display for SolveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.named(&Names::default()))
    }
}

impl std::error::Error for SolveError {}
