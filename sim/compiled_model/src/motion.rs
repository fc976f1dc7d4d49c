//! A simulated motion, the solver it comes from, and why it is that one.

use std::fmt;

use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::Trajectory;

use crate::audit::Audit;
use crate::error::Error;
use crate::projection::Moved;

/// How to integrate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Solver {
    /// [`Solver::Exact`] where the model is linear between its switches, else [`Solver::Rk`], and
    /// [`Solver::Radau`] where the motion turns out to be stiff.
    #[default]
    Auto,
    /// From switch to switch without any error but rounding; for models that are linear
    /// between their switches.
    Exact,
    /// Runge-Kutta of order 8 with location of the switching surfaces.
    Rk,
    /// Adams' multistep method of variable order, the paper's, with the same location.
    Adams,
    /// Radau's implicit method of order 5 with the model's own Jacobian and the same location, for
    /// stiff models.
    Radau,
}

impl Solver {
    /// Every solver.
    pub const ALL: [Self; 5] = [Self::Auto, Self::Exact, Self::Rk, Self::Adams, Self::Radau];

    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Exact => "exact",
            Self::Rk => "rk",
            Self::Adams => "adams",
            Self::Radau => "radau",
        }
    }
}

impl fmt::Display for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A motion at the samples that a solver came to.
#[derive(Clone, Debug)]
pub struct Motion {
    /// The states at the samples, the switches and the work.
    pub trajectory: Trajectory,
    /// What drove it.
    pub inputs: HeldInputs,
    /// Who computed it; never [`Solver::Auto`].
    pub solver: Solver,
    /// Why [`Solver::Auto`] took that solver; none where the solver was asked for.
    pub choice: Option<Choice>,
    /// Why the solver did not come to the end, if it did not.
    pub stopped: Option<Stopped>,
    /// What of the initial state was moved so that the constraints hold.
    pub moved: Vec<Moved>,
    /// The energy balance, if it was asked for.
    pub audit: Option<Audit>,
}

impl Motion {
    /// The motion, if the solver came to the end.
    ///
    /// # Errors
    /// [`Error::Stopped`] where it did not.
    pub fn complete(self) -> Result<Self, Error> {
        match self.stopped {
            None => Ok(self),
            Some(Stopped { t, reason, .. }) => Err(Error::Stopped { t, reason }),
        }
    }
}

/// Why a solver was taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Choice {
    /// The model is linear between its switches.
    PiecewiseLinear,
    /// It is not: the reason names the term.
    NotLinear(String),
    /// It is, but the exact solver does not follow this motion, for this reason.
    NotFollowed(String),
    /// It is stiff: what settles so fast that an explicit solver has no end in sight.
    Stiff(String),
}

/// Why a solver did not come to the end.
#[derive(Clone, Debug, PartialEq)]
pub struct Stopped {
    /// Where the motion stands, s, if that is known.
    pub t: Option<f64>,
    /// What is wrong, with names, and what to do.
    pub reason: String,
    /// What kind of reason that is.
    pub cause: Cause,
}

/// What kind of reason a solver has to stop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cause {
    /// Rates are infinite or not numbers, or the mass matrix is not positive definite.
    NotFinite,
    /// Switching surfaces are crossed too fast, or hold the motion.
    Switching,
    /// Stability keeps the steps of an explicit solver too short: what settles so fast.
    Stiff(String),
    /// No step is short enough, or there are too many of them.
    Limit,
}
