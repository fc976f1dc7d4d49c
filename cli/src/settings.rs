//! Parameter values of `--set`, given as `NAME=EXPR`.

use eomgen_compiled_model::split_assignments;
use eomgen_model_spec::model::Model;

use crate::error::{Error, Result};

/// Returns the model with the parameter values of `--set`.
pub fn with_settings(model: Model, assignments: &[String]) -> Result<Model> {
    let settings = settings(&model, assignments)?;
    let settings: Vec<(&str, f64)> = as_borrowed(&settings);
    model
        .with_parameters(&settings)
        .map_err(|error| Error::model(&model.source, error))
}

/// Evaluates every `NAME=EXPR` of `--set`. Returns names and values in declared units.
pub fn settings(model: &Model, assignments: &[String]) -> Result<Vec<(String, f64)>> {
    let given = split_assignments("--set", assignments)?;
    model.read_settings(&given).map_err(Error::Specification)
}

pub fn as_borrowed(values: &[(String, f64)]) -> Vec<(&str, f64)> {
    values
        .iter()
        .map(|(name, value)| (name.as_str(), *value))
        .collect()
}
