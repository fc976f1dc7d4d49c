//! Values given as `NAME=EXPR`, and inputs.

use eomgen_compiled_model::split_assignments;
use eomgen_model_spec::model::Model;

use crate::error::{Error, Result, warn};

/// Returns the model with every `NAME=EXPR` of `--set`.
pub fn with_settings(model: Model, assignments: &[String]) -> Result<Model> {
    let settings = settings(&model, assignments)?;
    let settings: Vec<(&str, f64)> = as_borrowed(&settings);
    model
        .with_parameters(&settings)
        .map_err(|error| Error::model(&model.source, error))
}

/// Reads every `NAME=EXPR` of `--set`. Returns names and values in declared units.
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

/// Warns about inputs that are not driven, except those of `driven`, with their values.
pub fn warn_of_inputs(model: &Model, driven: &[&str]) {
    let values = model.typical_inputs(0.0).unwrap_or_default();
    let own = model.inputs.iter().zip(values).enumerate();
    let own = own.filter(|(place, (input, _))| {
        input.rate_of.is_none() && !model.is_controlled(*place) && !driven.contains(&&*input.name)
    });
    for (_, (input, value)) in own {
        let name = &input.name;
        warn(&format!(
            "warning: input `{name}` is not driven and is taken as {value}; set it with --input {name}=..."
        ));
    }
}
