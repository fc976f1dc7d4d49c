//! Compiled models: the interface that the command line, sweeps, studies, discovery and the Python
//! package use to evaluate and simulate a specification.
//!
//! A [`CompiledModel`] holds the derived program of a specification, its machine code and its
//! piecewise-linear form. An [`Instance`] is a compiled model at one set of parameter values; it
//! simulates, linearises and finds equilibria. A [`Motion`] is the result, with the [`Solver`]
//! that computed it and the reason for that choice. The crate `codegen` derives the equations; the
//! crate `sim` integrates them.
//!
//! ```
//! use eomgen_compiled_model::{CompiledModel, Orders, Solver};
//!
//! let text = r#"
//! [model]
//! name = "oscillator"
//!
//! [parameters]
//! m = { value = 2, unit = "kg" }
//! k = { value = 8, unit = "N/m" }
//!
//! [coordinates]
//! x = { unit = "m", initial = 0.1 }
//!
//! [kinetic]
//! mass = "1/2*m*dot(x)^2"
//!
//! [potential]
//! spring = "1/2*k*x^2"
//! "#;
//! let model = CompiledModel::from_text("oscillator.toml", text, Orders::Declared)?;
//! let run = model.with_parameters(&[("k", 18.0)])?;
//! let times = [0.0, 0.5, 1.0];
//! let motion = run.simulate(run.initial_state(), &times, &run.default_inputs(), Solver::Auto)?;
//! assert_eq!(motion.solver, Solver::Exact);
//! for (t, state) in times.iter().zip(&motion.trajectory.states) {
//!     assert!((state[0] - 0.1 * (3.0 * t).cos()).abs() < 1e-12);
//! }
//! let observables = run.observables(&motion)?;
//! assert!((observables[2][0] - 0.09).abs() < 1e-12); // the energy, J
//! # Ok::<(), eomgen_compiled_model::Error>(())
//! ```
//!
//! An [`ExportedModel`] has the programs of a model without their derivation. An [`ExportedMotion`] simulates it in a
//! host program without derivation and machine code (feature `derive` off), such as a web page.

// Without the derivation, only motions of exported models use the remaining code.
#![cfg_attr(not(feature = "derive"), allow(dead_code, unused_imports))]

mod audit;
mod constraint_rank;
mod contacts;
mod controllers;
#[cfg(feature = "derive")]
mod coordinate_poles;
mod corners;
#[cfg(feature = "derive")]
mod cyclic_directions;
mod displacements;
mod driven_model;
#[cfg(feature = "derive")]
mod equilibrium;
mod error;
mod evaluation;
#[cfg(feature = "derive")]
mod event_log;
#[cfg(feature = "derive")]
mod exact_observers;
mod exported_model;
mod exported_motion;
#[cfg(feature = "derive")]
mod expression_inputs;
#[cfg(feature = "derive")]
mod fixed_steps;
mod general_motion;
mod general_run;
#[cfg(feature = "derive")]
mod gradients;
#[cfg(feature = "derive")]
mod infinite_inputs;
mod initial_consistency;
#[cfg(feature = "derive")]
mod initial_state;
#[cfg(feature = "derive")]
mod instance;
#[cfg(feature = "derive")]
mod instance_jacobians;
#[cfg(feature = "derive")]
mod instance_motion;
#[cfg(feature = "derive")]
mod jacobian_program;
mod jacobians;
mod labels;
#[cfg(feature = "derive")]
mod linearisation;
#[cfg(feature = "derive")]
mod lost_terms;
#[cfg(feature = "derive")]
mod model;
mod motion;
mod motion_model;
#[cfg(feature = "derive")]
mod natural_modes;
mod observers;
#[cfg(feature = "derive")]
mod operating_point;
#[cfg(feature = "derive")]
mod overlaps;
#[cfg(feature = "derive")]
mod prescribed_inputs;
mod projection;
#[cfg(feature = "derive")]
mod resumable;
#[cfg(feature = "derive")]
mod simulation;
mod singular_positions;
mod solver_options;
#[cfg(feature = "derive")]
mod state_space;
mod statistics;
mod sticking;
mod stop_reasons;
#[cfg(feature = "derive")]
mod typical_sizes;
#[cfg(feature = "derive")]
mod unresolved_integrals;

pub use audit::{Audit, Imbalance};
pub use controllers::{
    ControlLoop, ControlMemory, DeclaredController, NextSample, PendingOutputs, Sample,
    SampledController,
};
pub use driven_model::DrivenModel;
#[cfg(feature = "derive")]
pub use equilibrium::{Departure, Equilibrium, EquilibriumRequest, Stability};
pub use error::Error;
#[cfg(feature = "derive")]
pub use event_log::{EventKind, LoggedEvent};
pub use exported_model::{ExportedCode, ExportedModel};
pub use exported_motion::ExportedMotion;
#[cfg(feature = "derive")]
pub use expression_inputs::{
    ExpressionInputs, FunctionInputs, InputRole, InputTreatment, StepInputs,
};
#[cfg(feature = "derive")]
pub use gradients::{RecordedMotion, SampleWeights, TrajectoryGradient};
#[cfg(feature = "derive")]
pub use initial_state::StateRequest;
#[cfg(feature = "derive")]
pub use instance::Instance;
pub use jacobians::{Jacobian, JacobianEvaluator};
#[cfg(feature = "derive")]
pub use linearisation::Linearisation;
#[cfg(feature = "derive")]
pub use model::{CompiledModel, Orders};
pub use motion::{
    ControllerStates, EarlyStop, FrictionChoice, Motion, Solver, SolverChoice, StopCause,
};
#[cfg(feature = "derive")]
pub use operating_point::{OperatingPoint, Setting};
#[cfg(feature = "derive")]
pub use overlaps::Overlap;
#[cfg(feature = "derive")]
pub use prescribed_inputs::{list_undriven_inputs, split_assignments, with_prescribed_inputs};
pub use projection::{InitialChange, Projection};
#[cfg(feature = "derive")]
pub use resumable::Simulation;
#[cfg(feature = "derive")]
pub use simulation::Request;
pub use solver_options::{DEFAULT_TOLERANCE, SolverOptions};
#[cfg(feature = "derive")]
pub use statistics::{Measurement, Quantity, Statistic};
pub use sticking::{SidedModel, StickingMotion};
#[cfg(feature = "derive")]
pub use typical_sizes::TypicalSizes;
#[cfg(feature = "derive")]
pub use unresolved_integrals::UnresolvedIntegral;
