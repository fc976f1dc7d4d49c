//! The native part of the Python package `eomgen`: compiled models on numpy arrays, whose
//! arguments the package has brought into shape. Nothing is derived, integrated or searched here,
//! and nothing is known of how Python shows it: that is the package's own.
//!
//! `error` (the package's exceptions), `evaluators` (evaluators that wait for calls), `model` (a
//! model at its parameter values), `evaluation` (rows of an array), `linearisation`, `equilibrium`,
//! `interruption` (work that Python can stop), `simulation`, `discovery`, `equations`.

use pyo3::prelude::*;

mod discovery;
mod equations;
mod equilibrium;
mod error;
mod evaluation;
mod evaluators;
mod inputs;
mod interruption;
mod linearisation;
mod model;
mod simulation;

/// The module as Python loads it.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::discovery::discover;
    #[pymodule_export]
    use crate::equations::equations;
    #[pymodule_export]
    use crate::equilibrium::trim;
    #[pymodule_export]
    use crate::error::{DiscoveryError, SimulationError, SpecificationError};
    #[pymodule_export]
    use crate::evaluation::{jacobian, observables, rates};
    #[pymodule_export]
    use crate::linearisation::linearise;
    #[pymodule_export]
    use crate::model::{Model, nearest};
    #[pymodule_export]
    use crate::simulation::simulate;
    /// The highest order of a field.
    #[pymodule_export]
    const MAX_ORDER: usize = eomgen_model_spec::model::MAX_ORDER;
}
