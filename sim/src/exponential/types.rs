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
    /// Number of states with those of prescribed motions, which come last.
    pub(super) states: usize,
    pub(super) prescribed: PrescribedMotions,
    /// The typical size of each state.
    pub(super) typical_sizes: Vec<f64>,
    /// Degrees of freedom: as many positions come first in the state, then as many rates.
    pub(super) degrees: usize,
    /// Number of rates that forces act on: accelerations, and rates of states of first order.
    pub(super) forced: usize,
    /// The length of a step, s.
    pub(super) step: f64,
    /// The most surfaces that a motion may cross, and how many it did.
    pub(super) most_crossings: usize,
    pub(super) crossings: usize,
    /// The sides of the linear part by itself, the last such sides with their regime, and the
    /// difference of that regime from the present one.
    pub(super) own: Vec<Side>,
    pub(super) last_own: (Vec<Side>, usize),
    pub(super) apart: RegimeDifference,
    /// The evaluator's own parameters and those to their sides, by which is differentiated.
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
    /// Too many steps between two samples; the number required.
    TooManySteps(f64),
}

/// Present point of a motion.
pub(super) struct Motion {
    pub(super) t: f64,
    pub(super) state: Vec<f64>,
    pub(super) sides: Vec<Side>,
    pub(super) regime: usize,
    /// A unit constant and the inputs.
    pub(super) given: Vec<f64>,
    /// Contribution of these to a step.
    pub(super) base: Vec<f64>,
    /// Functions of the surfaces and their rates.
    pub(super) event_values: Vec<f64>,
    /// Nonlinear remainder there.
    pub(super) remainder: Remainder,
    /// End of a step, its nonlinear remainder, and half the change of the remainder.
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
