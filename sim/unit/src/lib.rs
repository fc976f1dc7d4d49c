//! Binary of functional mock-up units: a shared library with the functions of FMI 2.0 and FMI 3.0. It reads the
//! specification from the resources of the unit, derives the model and simulates it with the solvers of `eomgen
//! simulate`.
//!
//! `fmi2` and `fmi3` export the functions of the standard; `boundary` converts their pointers, catches panics
//! and reports rejections to the importer's logger. Only these modules have unsafe code. `unit` is an instance
//! with its modes and settings: `variables` reads and sets its variables by the value references of `layout`.
//! `motion` simulates it (co-simulation) or provides rates and events for the importer's solver (model
//! exchange). `derivatives` differentiates, and `saved_state` saves, restores and serialises it. `resources`
//! reads and checks the specification.
//!
//! There is no global state, so several instances can be used at once.

mod boundary;
mod derivatives;
mod fmi2;
mod fmi3;
mod layout;
mod motion;
mod rejection;
mod resources;
mod saved_state;
mod unit;
mod variables;

pub use layout::{Layout, Variable};
pub use resources::token;
pub use unit::find_surfaces;

/// Default tolerance of co-simulation, relative.
pub const DEFAULT_TOLERANCE: f64 = 1e-8;
