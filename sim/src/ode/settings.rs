//! How accurate, and how long to try.

/// A component that has not moved yet counts as this part of its typical size.
pub const UNMOVED_PART: f64 = 1e-9;

/// Smallest size of a component over which differences are taken, as a part of its typical size.
const DIFFERENCE_PART: f64 = 1e-3;

/// The step of a forward difference by a component with a value and a typical size.
pub fn difference_step(value: f64, typical_size: f64) -> f64 {
    f64::EPSILON.sqrt() * value.abs().max(DIFFERENCE_PART * typical_size)
}

/// The tightest tolerance: below it rounding hides the error estimate.
pub(super) const TIGHTEST_TOLERANCE: f64 = 1e-14;

/// The loosest tolerance that still means something.
pub(super) const LOOSEST_TOLERANCE: f64 = 1e-1;

/// How to step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Runge-Kutta steps of order 8 by Dormand and Prince.
    #[default]
    DormandPrince853,
    /// The multistep method of Adams with variable order, which begins anew behind every
    /// switching surface.
    Adams,
    /// Radau's implicit Runge-Kutta steps of order 5, for stiff systems.
    Radau,
}

/// Method, accuracy and limits of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How to step.
    pub method: Method,
    /// Relative error of one step, 1e-14 to 0.1; see the module's page.
    pub tolerance: f64,
    /// The longest step, s. Whatever lasts less long, such as a pulse of an input, may fall
    /// between the evaluations of longer steps and have no effect.
    pub max_step: f64,
    /// Give up after this many steps, rejected ones and those towards a switching
    /// surface included.
    pub max_steps: u64,
    /// Give up when what decays fastest keeps the steps of an explicit method so short that more
    /// than this many of them were needed to the end.
    pub max_steps_if_stiff: u64,
    /// Give up when switching surfaces are crossed faster than this, per second of
    /// simulated time and averaged over a few hundred crossings.
    pub max_switch_rate: f64,
}

impl Settings {
    /// The default limits with `tolerance`.
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self {
            tolerance,
            ..Self::default()
        }
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
