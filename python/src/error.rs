//! Exceptions of the package, and the conversion of Rust errors into exceptions.

use eomgen_compiled_model::Error;
use eomgen_discover::error::DiscoverError;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_records::Refusal;
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    eomgen,
    SpecificationError,
    PyValueError,
    "Invalid specification, dataset file or parameter value. The message contains the place, the cause and a remedy, \
     as on the command line."
);

create_exception!(
    eomgen,
    SimulationError,
    PyRuntimeError,
    "The solver stopped before the end. `trajectory` holds the samples up to then, or None if there are \
     none."
);

create_exception!(
    eomgen,
    DiscoveryError,
    PyRuntimeError,
    "Model and records cannot be compared."
);

/// Converts diagnostics of a specification or a dataset file.
pub fn specification(found: &Diagnostics) -> PyErr {
    SpecificationError::new_err(found.render(false))
}

/// Converts an error of compilation or simulation.
pub fn model(error: Error) -> PyErr {
    match error {
        Error::Specification(found) => specification(&found),
        Error::Request(reason) => PyValueError::new_err(reason),
        Error::Stopped { reason, .. } => SimulationError::new_err(reason),
    }
}

/// Converts an error of a search for effects.
pub fn discovery(error: DiscoverError) -> PyErr {
    match error {
        DiscoverError::Records(refusal) => records(*refusal),
        DiscoverError::Model(error) => model(*error),
        other => DiscoveryError::new_err(other.to_string()),
    }
}

/// Converts an error about rejected records.
pub fn records(refusal: Refusal) -> PyErr {
    match refusal {
        Refusal::Description(found) => specification(&found),
        Refusal::Record(message) => PyValueError::new_err(message),
        Refusal::Column(missing) => PyValueError::new_err(missing.message),
    }
}
