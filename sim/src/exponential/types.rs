//! Types of the exponential integrator.

use std::collections::HashMap;

use eomgen_codegen::program::affine::AffineEvaluator;

use super::parameter_derivatives::MovedParameters;
use super::prescribed_motions::PrescribedMotions;
use super::regime::Regime;
use super::remainder::{Force, RegimeDifference, Remainder};
use super::surfaces::{Side, Surfaces};
use super::tangents::Tangents;

/// Integrator of a model at fixed parameters.
pub struct ExponentialIntegrator {
    pub(super) evaluator: AffineEvaluator,
    pub(super) surfaces: Surfaces,
    pub(super) regimes: Vec<Regime>,
    pub(super) known: HashMap<Vec<Side>, Option<usize>>,
    /// Number of states, including the states of prescribed motions, which are the last ones.
    pub(super) states: usize,
    pub(super) prescribed: PrescribedMotions,
    /// Typical size of each state.
    pub(super) typical_sizes: Vec<f64>,
    /// Number of degrees of freedom: the state starts with this number of positions, then the same number of
    /// rates.
    pub(super) degrees: usize,
    /// Number of rates that forces act on: accelerations, and rates of first-order states.
    pub(super) forced: usize,
    /// Length of a step, s.
    pub(super) step: f64,
    /// Maximum number of events of a motion, and their number so far.
    pub(super) most_crossings: usize,
    pub(super) crossings: usize,
    /// Sides of the linear part by its own surfaces, the last different sides with their regime, and the
    /// difference between that regime and the current one.
    pub(super) own: Vec<Side>,
    pub(super) last_linear_sides: (Vec<Side>, usize),
    pub(super) regime_difference: RegimeDifference,
    /// Parameters of the evaluator, and changed parameters for difference quotients.
    pub(super) own_parameters: Vec<f64>,
    pub(super) moved: Vec<Vec<MovedParameters>>,
}

/// Reason why the fixed-step integrator does not support a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UnsupportedModel {
    /// Unsupported terms, or invalid parameters.
    UnsupportedTerms,
    /// A surface holds the motion by forces whose direction depends on the state or the inputs.
    VaryingHoldingDirection,
    /// Too many steps between two samples; contains the required number.
    TooManySteps(f64),
}

/// Current point of a motion.
pub(super) struct Motion {
    pub(super) t: f64,
    pub(super) state: Vec<f64>,
    pub(super) sides: Vec<Side>,
    pub(super) regime: usize,
    /// A unit constant and the inputs.
    pub(super) given: Vec<f64>,
    /// Contribution of `given` to a step.
    pub(super) base: Vec<f64>,
    /// Functions of the surfaces, then their rates.
    pub(super) event_values: Vec<f64>,
    /// Nonlinear remainder at the current state.
    pub(super) remainder: Remainder,
    /// State at the end of a trial step, its nonlinear remainder, and half the change of the remainder.
    pub(super) next: Vec<f64>,
    pub(super) later: Remainder,
    pub(super) change: Vec<f64>,
}

/// Optional additions to a simulation.
pub struct Options<'c, 'd> {
    /// Accelerations that are added to those of the linear part.
    pub force: Option<&'c mut dyn Force>,
    /// Tangent vectors.
    pub tangents: Option<&'c mut Tangents<'d>>,
}

/// Callback for each sample: its index, the state and the tangent vectors.
pub type SampleCallback<'s> = dyn FnMut(usize, &[f64], Option<&Tangents<'_>>) + 's;
