//! Certificates of a model.

use eomgen_compiled_model::Error;
use eomgen_validate::model_certificate::certify_model;
use pyo3::prelude::*;

use crate::error;
use crate::generation::parse_outputs;
use crate::model::Model;

/// Certifies a model, with the additional outputs `extras`. Returns the document `certificate.json`.
#[pyfunction]
pub fn validate(py: Python<'_>, model: &Model, extras: Vec<String>) -> PyResult<String> {
    let outputs = parse_outputs(&extras)?;
    let certified = || {
        let declared = model.instance()?.valued_model()?;
        let certificate = certify_model(&declared, model.compiled().orders(), &outputs)?;
        serde_json::to_string(&certificate).map_err(|error| Error::Request(error.to_string()))
    };
    py.detach(certified).map_err(error::model)
}
