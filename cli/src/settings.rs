//! Parameter values given as `NAME=VALUE`, and inputs that nothing gives.

use model_spec::model::Model;

use crate::problem::{Outcome, Problem, warn};

/// The model with every `NAME=VALUE`, values in the units that the specification declares.
pub fn with_settings(model: Model, assignments: &[String]) -> Outcome<Model> {
    let settings = assignments
        .iter()
        .map(|assignment| setting(assignment))
        .collect::<Outcome<Vec<_>>>()?;
    model
        .with_parameters(&settings)
        .map_err(|error| Problem::model(&model.source, error))
}

/// The parts of `NAME=VALUE`.
pub fn setting(assignment: &str) -> Outcome<(&str, f64)> {
    let (name, value) = assignment.split_once('=').ok_or_else(|| {
        Problem::input(format!(
            "--set {assignment}: expected NAME=VALUE, such as b_sp=25e-6"
        ))
    })?;
    let number: f64 = value
        .trim()
        .parse()
        .map_err(|_| Problem::input(format!("--set {assignment}: \"{value}\" is no number")))?;
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
