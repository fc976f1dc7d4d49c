//! The exceptions that the package raises, and which of them an error of the library becomes.

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
    "A specification, a dataset file or a parameter value that is wrong: where, what is wrong and \
     what would be right, in the words of the command line."
);

create_exception!(
    eomgen,
    SimulationError,
    PyRuntimeError,
    "A motion that could not be followed to the end. `trajectory` holds the samples until there; \
     it is None where there are none."
);

create_exception!(
    eomgen,
    DiscoveryError,
    PyRuntimeError,
    "Records that nothing can be compared with."
);

/// What is wrong with a text that people write.
pub fn specification(found: &Diagnostics) -> PyErr {
    SpecificationError::new_err(found.render(false))
}

/// What keeps a model from being compiled or run.
pub fn model(error: Error) -> PyErr {
    match error {
        Error::Specification(found) => specification(&found),
        Error::Request(reason) => PyValueError::new_err(reason),
        Error::Stopped { reason, .. } => SimulationError::new_err(reason),
    }
}

/// What stopped a search.
pub fn discovery(error: DiscoverError) -> PyErr {
    match error {
        DiscoverError::Records(refusal) => records(*refusal),
        DiscoverError::Model(error) => model(*error),
        other => DiscoveryError::new_err(other.to_string()),
    }
}

/// Records that are not taken.
pub fn records(refusal: Refusal) -> PyErr {
    match refusal {
        Refusal::Description(found) => specification(&found),
        Refusal::Record(message) => PyValueError::new_err(message),
    }
}
