//! Errors of a simulation.

use std::fmt;

use super::names::Names;

/// Message for a mass matrix that is not positive definite.
pub const NOT_POSITIVE_DEFINITE_MESSAGE: &str = "the mass matrix is not positive definite: check for a mass, inertia \
                                                 or length that is zero or negative";

/// Reason why a simulation stopped; times in s.
#[derive(Clone, Debug, PartialEq)]
pub enum SolveError {
    /// The request is invalid.
    Request {
        /// Fault of the request and its correction.
        problem: String,
    },
    /// A rate is not finite at this time, or after the shortest step from this time.
    NotFinite {
        /// Time, s.
        t: f64,
        /// Index of the state.
        state: usize,
    },
    /// The mass matrix is not positive definite at a state of the motion.
    NotPositiveDefinite {
        /// Time, s.
        t: f64,
        /// Index of the coordinate whose pivot is not positive after the elimination of the preceding
        /// coordinates.
        coordinate: usize,
    },
    /// The shortest step does not meet the tolerance.
    StepTooSmall {
        /// Time reached, s.
        t: f64,
        /// Length of the rejected step, s.
        step: f64,
        /// Index of the state that changes fastest relative to its size.
        state: usize,
    },
    /// The system is stiff: stability limits the step size, and the limit on the number of steps would be
    /// exceeded.
    Stiff {
        /// Time reached, s.
        t: f64,
        /// Index of the state that decays fastest.
        state: usize,
        /// Decay time of this state, s.
        within: f64,
        /// Estimated number of further steps.
        steps: f64,
    },
    /// The system is stiff at a switching surface: an explicit method overshoots it unless the steps are very
    /// short. They would exceed the limit on the number of steps.
    StiffAtSurface {
        /// Time, s.
        t: f64,
        /// Index of the switching function.
        guard: usize,
        /// Average time between two approaches to the surface, s.
        within: f64,
        /// Estimated number of further steps.
        steps: f64,
    },
    /// The limit on steps is reached.
    TooManySteps {
        /// Time reached, s.
        t: f64,
        /// Limit on steps.
        steps: u64,
        /// Index of the state that changes fastest relative to its size.
        state: usize,
    },
    /// A switching surface holds the motion: the rates on both sides point towards it.
    Sticking {
        /// Time reached, s.
        t: f64,
        /// Index of the switching function.
        guard: usize,
    },
    /// Events follow each other too fast.
    TooManySwitches {
        /// Time reached, s.
        t: f64,
        /// Index of the last switching function.
        guard: usize,
        /// Limit, 1/s.
        rate: f64,
    },
}

impl SolveError {
    /// Returns the time reached, s; `None` if the simulation had not started.
    pub fn time(&self) -> Option<f64> {
        match *self {
            Self::Request { .. } => None,
            Self::NotFinite { t, .. }
            | Self::NotPositiveDefinite { t, .. }
            | Self::StepTooSmall { t, .. }
            | Self::Stiff { t, .. }
            | Self::StiffAtSurface { t, .. }
            | Self::TooManySteps { t, .. }
            | Self::Sticking { t, .. }
            | Self::TooManySwitches { t, .. } => Some(t),
        }
    }

    /// Returns the message: cause, time, state or surface, and remedy.
    pub fn format_named(&self, names: &Names<'_>) -> String {
        match self {
            Self::Request { problem } => problem.clone(),
            Self::NotFinite { t, state } => format!(
                "the state diverged at t = {t:?} s, a number overflowed (a parameter is far too large or \
                 too small), or a function left its domain (for example sqrt of a negative number) in \
                 the rate of {}; check the parameters and the initial state, keep the function in its \
                 domain (as sqrt(max(x, 0)) does), or shorten the time",
                names.state_name(*state)
            ),
            Self::NotPositiveDefinite { t, coordinate } => format!(
                "at t = {t:?} s the mass matrix is not positive definite: the inertia of {} is \
                 zero or negative, so no acceleration is determined; check the kinetic energy \
                 in that position",
                names.state_name(*coordinate)
            ),
            Self::StepTooSmall { t, step, state } => format!(
                "at t = {t:?} s no step meets the tolerance (last step: {step:e} s), because {} changes \
                 too fast. The state diverges, or its rate is singular; check the \
                 parameters, loosen the tolerance, or shorten the time",
                names.state_name(*state)
            ),
            Self::Stiff {
                t,
                state,
                within,
                steps,
            } => format!(
                "stopped at t = {t:?} s: the model is stiff. {} settles within {within:.1e} s, \
                 so an explicit solver would need {steps:.1e} more steps; use the implicit solver \
                 radau, or soften the cause (a stiff spring or damper, or a smooth friction law \
                 that is too steep)",
                names.state_name(*state)
            ),
            Self::StiffAtSurface {
                t,
                guard,
                within,
                steps,
            } => format!(
                "stopped at t = {t:?} s: the model is stiff near the place where {}, as the flow \
                 sqrt(abs(p)) of an orifice is near p = 0. An explicit solver has to take steps of \
                 {within:.1e} s there, {steps:.1e} more of them; take the solver radau, which is \
                 implicit, or make the flow linear near zero",
                names.surface_condition(*guard)
            ),
            Self::TooManySteps { t, steps, state } => format!(
                "stopped at t = {t:?} s after {steps} steps: {} moves too fast for such a \
                 long time; loosen the tolerance or shorten the time",
                names.state_name(*state)
            ),
            Self::Sticking { t, guard } => format!(
                "at t = {t:?} s the motion stays on the switching surface on which {}: {}",
                names.surface_condition(*guard),
                names.sticking_reason(*guard)
            ),
            Self::TooManySwitches { t, guard, rate } => format!(
                "at t = {t:?} s the motion crosses the switching surface on which {} more than {rate:e} times per \
                 second: {}",
                names.surface_condition(*guard),
                names.sticking_reason(*guard)
            ),
        }
    }
}

impl fmt::Display for SolveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.format_named(&Names::default()))
    }
}

impl std::error::Error for SolveError {}
