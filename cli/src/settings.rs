//! Parameter values given as `NAME=VALUE`, and inputs that nothing gives.

use eomgen_model_spec::model::Model;

use crate::error::{Error, Result, warn};

/// The model with every `NAME=VALUE`, values in the units that the specification declares.
pub fn with_settings(model: Model, assignments: &[String]) -> Result<Model> {
    let settings = assignments
        .iter()
        .map(|assignment| setting(assignment))
        .collect::<Result<Vec<_>>>()?;
    model
        .with_parameters(&settings)
        .map_err(|error| Error::model(&model.source, error))
}

/// The parts of `NAME=VALUE`.
pub fn setting(assignment: &str) -> Result<(&str, f64)> {
    let (name, value) = assignment.split_once('=').ok_or_else(|| {
        Error::input(format!(
            "--set {assignment}: expected NAME=VALUE, such as b_sp=25e-6"
        ))
    })?;
    let number: f64 = value
        .trim()
        .parse()
        .map_err(|_| Error::input(format!("--set {assignment}: \"{value}\" is no number")))?;
    Ok((name.trim(), number))
}

/// Says which inputs are 0 where there is no record.
pub fn warn_of_inputs(model: &Model) {
    for input in &model.inputs {
        warn(&format!(
            "warning: no record gives the input `{}`: it is 0",
            input.name
        ));
    }
}
