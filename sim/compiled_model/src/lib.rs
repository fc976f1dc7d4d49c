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

mod audit;
mod contacts;
mod controllers;
mod corners;
mod cyclic_directions;
mod driven_model;
mod equilibrium;
mod error;
mod event_log;
mod fixed_steps;
mod general_run;
mod infinite_inputs;
mod initial_consistency;
mod initial_state;
mod instance;
mod jacobian_program;
mod jacobians;
mod linearisation;
mod model;
mod motion;
mod natural_modes;
mod operating_point;
mod overlaps;
mod prescribed_inputs;
mod projection;
mod resumable;
mod simulation;
mod singular_positions;
mod state_space;
mod step_inputs;
mod sticking;
mod stop_reasons;
mod typical_sizes;

pub use audit::{Audit, Imbalance};
pub use controllers::{DeclaredController, Sample, SampledController};
pub use driven_model::DrivenModel;
pub use equilibrium::{Departure, Equilibrium, EquilibriumRequest, Stability};
pub use error::Error;
pub use event_log::{EventKind, LoggedEvent};
pub use initial_state::StateRequest;
pub use instance::Instance;
pub use jacobians::{Jacobian, JacobianEvaluator};
pub use linearisation::Linearisation;
pub use model::{CompiledModel, Orders};
pub use motion::{ControllerStates, EarlyStop, Motion, Solver, SolverChoice, StopCause};
pub use operating_point::{OperatingPoint, Setting};
pub use overlaps::Overlap;
pub use prescribed_inputs::{split_assignments, with_prescribed_inputs};
pub use projection::InitialChange;
pub use resumable::{Simulation, SolverOptions};
pub use simulation::{DEFAULT_TOLERANCE, Request};
pub use step_inputs::{StepInputs, with_input_functions};
pub use sticking::{SidedModel, StickingMotion};
pub use typical_sizes::TypicalSizes;
