//! Native part of the Python package `eomgen`: compiled models on NumPy arrays. The Python code converts arguments
//! and displays results; the libraries derive, integrate and search.

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
mod resumable;
mod simulation;

/// Python module.
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
    use crate::resumable::Simulation;
    #[pymodule_export]
    use crate::simulation::simulate;
    /// Highest order of a field.
    #[pymodule_export]
    const MAX_ORDER: usize = eomgen_model_spec::model::MAX_ORDER;
}
