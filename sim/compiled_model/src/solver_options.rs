//! Solver and accuracy of a simulation.

use eomgen_sim::ode::{Method, Settings};

use crate::motion::Solver;

/// Default relative tolerance.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;

/// Maximum number of explicit steps, if stability limits their length, before [`Solver::Auto`] changes to the implicit
/// solver. The implicit solver then needs a fraction of the time for the trajectory.
pub(crate) const MAX_STIFF_STEPS: u64 = 100_000;

/// Solver and accuracy of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverOptions {
    /// Solver of the equations of motion.
    pub solver: Solver,
    /// Relative tolerance; [`Solver::Exact`] ignores it.
    pub tolerance: f64,
    /// Longest step, s; [`Solver::Exact`] ignores it, and [`Solver::Fixed`] takes steps of this length.
    pub max_step: f64,
}

impl Default for SolverOptions {
    fn default() -> Self {
        Self {
            solver: Solver::Auto,
            tolerance: DEFAULT_TOLERANCE,
            max_step: f64::INFINITY,
        }
    }
}

impl SolverOptions {
    pub(crate) fn settings(&self, method: Method) -> Settings {
        let max_steps_if_stiff = match self.solver {
            Solver::Auto => MAX_STIFF_STEPS,
            _ => Settings::default().max_steps_if_stiff,
        };
        Settings {
            method,
            max_step: self.max_step,
            max_steps_if_stiff,
            ..Settings::with_tolerance(self.tolerance)
        }
    }
}

/// Returns the method of a solver that supports any model.
pub(crate) fn general_method(solver: Solver) -> Method {
    match solver {
        Solver::Radau => Method::Radau,
        Solver::Adams => Method::Adams,
        Solver::Auto | Solver::Exact | Solver::Rk | Solver::Fixed => Method::DormandPrince853,
    }
}
