//! Native part of the Python package `eomgen`: compiled models with NumPy arrays. The Python code converts arguments
//! and displays results; the Rust libraries derive, integrate and search.

use pyo3::prelude::*;

mod certification;
mod comparison;
mod controller;
mod discovery;
mod equations;
mod equilibrium;
mod error;
mod evaluation;
mod evaluators;
mod generation;
mod gradient;
mod inputs;
mod interruption;
mod linearisation;
mod model;
mod modes;
mod operating_point;
mod resumable;
mod simulation;
mod sweeping;

/// Python module.
#[pymodule]
mod _native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::certification::validate;
    #[pymodule_export]
    use crate::comparison::compare;
    #[pymodule_export]
    use crate::discovery::discover;
    #[pymodule_export]
    use crate::equations::{derive, equations};
    #[pymodule_export]
    use crate::equilibrium::trim;
    #[pymodule_export]
    use crate::error::{DiscoveryError, SimulationError, SpecificationError};
    #[pymodule_export]
    use crate::evaluation::{jacobian, mass_matrix, observables, rates};
    #[pymodule_export]
    use crate::generation::generate;
    #[pymodule_export]
    use crate::gradient::RecordedMotion;
    #[pymodule_export]
    use crate::inputs::{RefusedType, RefusedValue};
    #[pymodule_export]
    use crate::linearisation::{discretise, linearise};
    #[pymodule_export]
    use crate::model::{Model, nearest};
    #[pymodule_export]
    use crate::modes::modes;
    #[pymodule_export]
    use crate::operating_point::move_onto_constraints;
    #[pymodule_export]
    use crate::resumable::Simulation;
    #[pymodule_export]
    use crate::simulation::simulate;
    #[pymodule_export]
    use crate::sweeping::sweep;
    /// Version of the package.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
    /// Highest order of a field.
    #[pymodule_export]
    const MAX_ORDER: usize = eomgen_model_spec::model::MAX_ORDER;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        eomgen_model_spec::argument::name_python_arguments();
        // The exceptions have no samples by default.
        module
            .getattr("SimulationError")?
            .setattr("trajectory", module.py().None())
    }
}
