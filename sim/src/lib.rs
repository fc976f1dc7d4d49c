//! Solvers for derived models.
//!
//! [`ode`] integrates any model and locates its switches; [`piecewise_linear`] propagates a model
//! that is linear between its switches exactly; [`exponential`] steps through one that nearly is,
//! with its derivatives by initial states. [`inputs`] are what drives a motion. How a model is
//! derived is the business of `codegen`, which solver takes it that of the compiled model.

pub mod exponential;
pub mod inputs;
pub mod ode;
pub mod piecewise_linear;
