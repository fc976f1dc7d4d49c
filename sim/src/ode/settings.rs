//! Method, tolerance and limits of a simulation.

use super::error::SolveError;

/// Size of a component before it moves, as a fraction of its typical size.
pub const UNMOVED_SIZE_FRACTION: f64 = 1e-9;

/// Smallest size of a component for finite differences, as a fraction of its typical size.
const MIN_DIFFERENCE_SIZE_FRACTION: f64 = 1e-3;

/// Returns the step of a forward difference with respect to a component, from its value and
/// typical size.
pub fn difference_step(value: f64, typical_size: f64) -> f64 {
    f64::EPSILON.sqrt() * value.abs().max(MIN_DIFFERENCE_SIZE_FRACTION * typical_size)
}

/// Smallest tolerance; rounding dominates the error estimate at smaller ones.
const MIN_TOLERANCE: f64 = 1e-14;

/// Largest tolerance.
const MAX_TOLERANCE: f64 = 1e-1;

/// Integration method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Dormand-Prince Runge-Kutta method of order 8.
    #[default]
    DormandPrince853,
    /// Adams multistep method of variable order; it restarts after every event.
    Adams,
    /// Implicit Radau IIA Runge-Kutta method of order 5, for stiff systems.
    Radau,
}

/// Method, tolerance and limits of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Integration method.
    pub method: Method,
    /// Relative error of one step, 1e-14 to 0.1; see the [module](super).
    pub tolerance: f64,
    /// Longest step, s. Longer steps may miss a shorter effect, such as a pulse of an input.
    pub max_step: f64,
    /// Maximum number of steps, including rejected steps and steps to a switching surface.
    pub max_steps: u64,
    /// Maximum number of steps of an explicit method on a stiff system. The simulation stops as
    /// soon as stability would require more.
    pub max_steps_if_stiff: u64,
    /// Maximum number of events per second of simulated time, averaged over a few hundred events.
    pub max_switch_rate: f64,
}

impl Settings {
    /// Returns the default settings with this tolerance.
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self {
            tolerance,
            ..Self::default()
        }
    }

    /// Checks the tolerance and the longest step.
    ///
    /// # Errors
    /// [`SolveError::Request`] with the limit that is violated.
    pub fn check(&self) -> Result<(), SolveError> {
        let refuse = |problem| Err(SolveError::Request { problem });
        if !(MIN_TOLERANCE..=MAX_TOLERANCE).contains(&self.tolerance) {
            return refuse(format!(
                "the tolerance {:e} must be between {MIN_TOLERANCE:e} and {MAX_TOLERANCE}",
                self.tolerance
            ));
        }
        if self.max_step.is_nan() || self.max_step <= 0.0 {
            return refuse(format!(
                "the longest step, {} s, must be greater than 0",
                self.max_step
            ));
        }
        Ok(())
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::default(),
            tolerance: 1e-9,
            max_step: f64::INFINITY,
            max_steps: 20_000_000,
            max_steps_if_stiff: 20_000_000,
            max_switch_rate: 1e6,
        }
    }
}
