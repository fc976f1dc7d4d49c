//! Simulated motions, the solvers, and the reasons for the choice or the stop of a solver.

use std::fmt;

use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{Surface, Trajectory};

use crate::audit::Audit;
use crate::error::Error;
use crate::projection::InitialChange;

/// Solver of the equations of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Solver {
    /// [`Solver::Exact`] if the model is piecewise linear, otherwise [`Solver::Rk`], which changes to [`Solver::Radau`]
    /// if the motion is stiff.
    #[default]
    Auto,
    /// Exact propagation from event to event, with rounding errors only; for piecewise-linear
    /// models.
    Exact,
    /// Runge-Kutta method of order 8 (Dormand and Prince) with event location.
    Rk,
    /// Adams multistep method of variable order, as used in the paper, with event location.
    Adams,
    /// Implicit Radau IIA method of order 5 with the model's Jacobian and event location, for
    /// stiff models.
    Radau,
    /// Classical Runge-Kutta method of order 4 with steps of the given length, for smooth models. Inputs are held
    /// during a step.
    Fixed,
}

impl Solver {
    /// Every solver.
    pub const ALL: [Self; 6] = [
        Self::Auto,
        Self::Exact,
        Self::Rk,
        Self::Adams,
        Self::Radau,
        Self::Fixed,
    ];

    /// Returns the name used on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Exact => "exact",
            Self::Rk => "rk",
            Self::Adams => "adams",
            Self::Radau => "radau",
            Self::Fixed => "fixed",
        }
    }
}

impl fmt::Display for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Motion, sampled up to the end or the early stop of the solver.
#[derive(Clone, Debug)]
pub struct Motion {
    /// States at the samples, number of events and solver statistics.
    pub trajectory: Trajectory,
    /// Switching surfaces of the events, in the order of their functions.
    pub surfaces: Vec<Surface>,
    /// Inputs of the motion.
    pub inputs: HeldInputs,
    /// Solver that computed the motion; never [`Solver::Auto`].
    pub solver: Solver,
    /// Reason for the choice of [`Solver::Auto`]; `None` if the solver was requested by name.
    pub solver_choice: Option<SolverChoice>,
    /// Reason why the solver stopped early; `None` if it reached the end.
    pub early_stop: Option<EarlyStop>,
    /// Changes of the initial state by the projection onto the constraints.
    pub initial_changes: Vec<InitialChange>,
    /// Energy balance, if requested.
    pub audit: Option<Audit>,
    /// Results of the requested `Measurement`s, in the units of their quantities; `None` if the motion ended before the
    /// start of the measurement.
    pub measured: Vec<Option<f64>>,
    /// States of the controllers.
    pub controller_states: ControllerStates,
    /// Times at which contact friction admits several motions.
    pub friction_choices: Vec<FrictionChoice>,
}

/// Time at which contact friction admits several motions. The motion with the fewest mode changes was taken, and among
/// several of these the one with the smallest forces.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionChoice {
    /// Time, s.
    pub t: f64,
    /// Names of the impacts whose modes were determined together.
    pub impacts: Vec<String>,
    /// Number of admissible motions.
    pub motions: usize,
}

impl FrictionChoice {
    /// Returns a sentence about all such times of a motion; `None` if there are none.
    pub fn describe_all(all: &[Self]) -> Option<String> {
        let first = all.first()?;
        let impacts: Vec<String> = first
            .impacts
            .iter()
            .map(|name| format!("`{name}`"))
            .collect();
        let later = match all.len() {
            1 => String::new(),
            count => format!(", and {} times later", count - 1),
        };
        Some(format!(
            "at t = {:?} s contact friction at {} admits {} motions{later}: the motion with the fewest changes \
             between sticking and sliding is used, and among equals the one with the smallest forces",
            first.t,
            impacts.join(", "),
            first.motions
        ))
    }
}

/// States of the controllers of a motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ControllerStates {
    /// Names.
    pub names: Vec<String>,
    /// Values at each sample of the motion, SI. A controller sample at the same time is already included.
    pub rows: Vec<Vec<f64>>,
}

impl Motion {
    /// Returns the motion if the solver reached the end.
    ///
    /// # Errors
    /// [`Error::Stopped`] if the solver stopped early.
    pub fn into_complete(self) -> Result<Self, Error> {
        match self.early_stop {
            None => Ok(self),
            Some(EarlyStop { t, reason, .. }) => Err(Error::Stopped { t, reason }),
        }
    }
}

/// Reason for the choice of a solver.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SolverChoice {
    /// The model is piecewise linear.
    PiecewiseLinear,
    /// The model is not piecewise linear; the text names the term.
    NotPiecewiseLinear(String),
    /// The model is piecewise linear, but the exact solver does not support this motion; the text gives the reason.
    NotSupportedByExact(String),
    /// The model is stiff; the text names the state and its settling time.
    Stiff(String),
}

/// Reason why a solver stopped early.
#[derive(Clone, Debug, PartialEq)]
pub struct EarlyStop {
    /// Time of the stop, s, if known.
    pub t: Option<f64>,
    /// Cause, with names, and remedy.
    pub reason: String,
    /// Category of the cause.
    pub cause: StopCause,
}

/// Category of the reason why a solver stopped early.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StopCause {
    /// Rates that are not finite, or a mass matrix that is not positive definite.
    NotFinite,
    /// Too many events in a short time, or a surface that holds the motion.
    Switching,
    /// Stiffness that limits the steps of an explicit solver; the text names the state.
    Stiff(String),
    /// A step below the smallest length, or too many steps.
    Limit,
}

impl From<EarlyStop> for Error {
    fn from(EarlyStop { t, reason, .. }: EarlyStop) -> Self {
        Self::Stopped { t, reason }
    }
}
