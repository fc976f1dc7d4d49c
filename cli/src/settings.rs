//! Values given as `NAME=EXPR`, and inputs.

use eomgen_model_spec::assignment::Assignment;
use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::edit::{self, Edit, EditError, PrescribeInput};
use eomgen_model_spec::model::{Model, ParameterValue, STABILISATION_RATE};
use eomgen_model_spec::source::Source;
use eomgen_model_spec::suggest::did_you_mean;

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
    let given = split("--set", assignments)?;
    model.read_settings(&given).map_err(Error::Specification)
}

/// Parses every `NAME=EXPR` of an option.
pub fn split(option: &str, assignments: &[String]) -> Result<Vec<Assignment>> {
    let split = assignments
        .iter()
        .map(|text| Assignment::split(option, text));
    let split: std::result::Result<Vec<_>, _> = split.collect();
    split.map_err(Error::Specification)
}

pub fn as_borrowed(values: &[(String, f64)]) -> Vec<(&str, f64)> {
    values
        .iter()
        .map(|(name, value)| (name.as_str(), *value))
        .collect()
}

/// Default decay rate of constraint residuals in models whose rates are integrated directly, 1/s.
const DEFAULT_STABILISATION_RATE: f64 = 10.0;

/// Returns the model with decaying constraint residuals, for solvers that integrate its rates directly.
pub fn with_stabilisation(model: Model) -> Result<Model> {
    let declared = model
        .parameters
        .iter()
        .find(|p| p.name == STABILISATION_RATE);
    let is_off = declared.is_some_and(|p| matches!(p.value, ParameterValue::Number(0.0)));
    if model.constraints.is_empty() || !is_off {
        return Ok(model);
    }
    model
        .with_parameters(&[(STABILISATION_RATE, DEFAULT_STABILISATION_RATE)])
        .map_err(|error| Error::model(&model.source, error))
}

/// Returns the model with inputs replaced by the `NAME=EXPR` of `--input`.
pub fn with_inputs(mut model: Model, prescribed: &[String]) -> Result<Model> {
    for text in prescribed {
        let given = Assignment::split("--input", text).map_err(Error::Specification)?;
        let edit = Edit::PrescribeInput(PrescribeInput {
            name: given.name().to_owned(),
            value: given.value().to_owned(),
        });
        let edited = edit::apply(&model.source, &[edit]);
        let edited = edited.map_err(|error| not_prescribed(&error, &given, &model))?;
        let source = model.source.with_text(edited);
        let checked = eomgen_model_spec::check(source).map_err(Error::Specification)?;
        model = checked.model;
    }
    Ok(model)
}

/// Returns the error of `--input` at its place in the option's text.
fn not_prescribed(error: &EditError, given: &Assignment, model: &Model) -> Error {
    let found = match error {
        EditError::Invalid(found) => given.relocated(found),
        EditError::Expression { text, diagnostic } => {
            let source = Source::new("--input", text.as_str());
            given.relocated(&Diagnostics::from_one(source, (**diagnostic).clone()))
        }
        EditError::MissingTerm { .. } => Some(given.name_error(messages(error, model), None)),
        _ => None,
    };
    match found {
        Some(found) => Error::Specification(found),
        None => Error::input(format!(
            "--input {}: {}",
            given.text(),
            messages(error, model)
        )),
    }
}

/// Returns the messages of an edit, without places: these refer to the edited text.
fn messages(error: &EditError, model: &Model) -> String {
    match error {
        EditError::Invalid(found) => {
            let messages: Vec<String> = found.list().iter().map(Diagnostic::summary).collect();
            messages.join("; ")
        }
        EditError::MissingTerm { name, .. } => {
            let inputs = model.inputs.iter().filter(|input| input.rate_of.is_none());
            let inputs: Vec<&str> = inputs.map(|input| input.name.as_str()).collect();
            let meant = did_you_mean(name, inputs.iter().copied());
            let cure = meant.unwrap_or_else(|| match inputs.is_empty() {
                true => "it has none; remove --input".to_owned(),
                false => format!("it has {}", inputs.join(", ")),
            });
            format!("the model has no input `{name}`; {cure}")
        }
        error => error.to_string(),
    }
}

/// Warns about inputs that are not driven, with their values.
pub fn warn_of_inputs(model: &Model) {
    let values = model.typical_inputs(0.0).unwrap_or_default();
    let own = model.inputs.iter().zip(values);
    for (input, value) in own.filter(|(input, _)| input.rate_of.is_none()) {
        let name = &input.name;
        warn(&format!(
            "warning: input `{name}` is not driven and is taken as {value}; set it with --input {name}=..."
        ));
    }
}
