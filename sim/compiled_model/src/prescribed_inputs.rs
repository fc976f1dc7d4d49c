//! Inputs given by expressions of time and parameters, as `NAME=EXPR`.

use eomgen_model_spec::argument::Argument;
use eomgen_model_spec::assignment::Assignment;
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::edit::{self, Edit, EditError, PrescribeInput};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_model_spec::suggest::did_you_mean;

use crate::error::Error;

/// Splits every `NAME=VALUE` of an option. `option`, for example `--input`, replaces the file name in messages.
///
/// # Errors
/// A text that is not `NAME=VALUE`, or a repeated name.
pub fn split_assignments(option: &str, texts: &[String]) -> Result<Vec<Assignment>, Error> {
    let split = texts.iter().map(|text| Assignment::split(option, text));
    let split = split
        .collect::<Result<Vec<Assignment>, Diagnostics>>()
        .map_err(Error::Specification)?;
    for (place, given) in split.iter().enumerate() {
        let mut earlier = split[..place].iter();
        if let Some(first) = earlier.find(|other| other.name() == given.name()) {
            let (name, [first, second]) = (given.name(), [first, given].map(Assignment::value));
            return Err(Error::Request(format!(
                "{option}: `{name}` is given twice, as {first} and as {second}; give one value"
            )));
        }
    }
    Ok(split)
}

/// Returns the model with each of the given inputs replaced by a definition.
///
/// # Errors
/// An unknown or repeated input, or an invalid expression, with its location in the option.
pub fn with_prescribed_inputs(mut model: Model, given: &[Assignment]) -> Result<Model, Error> {
    for given in given {
        let edit = Edit::PrescribeInput(PrescribeInput {
            name: given.name().to_owned(),
            value: given.value().to_owned(),
        });
        let edited = edit::apply(&model.source, &[edit]);
        let edited = edited.map_err(|error| prescription_error(&error, given, &model))?;
        let source = model.source.with_text(edited);
        model = eomgen_model_spec::check(source)?.model;
    }
    Ok(model)
}

/// Returns a warning with the default value for every input that is not in `driven`.
pub fn list_undriven_inputs(model: &Model, driven: &[&str]) -> Vec<String> {
    let values = model.typical_inputs(0.0).unwrap_or_default();
    let own = model.inputs.iter().zip(values).enumerate();
    let own = own.filter(|(place, (input, _))| {
        input.rate_of.is_none() && !model.is_controlled(*place) && !driven.contains(&&*input.name)
    });
    own.map(|(_, (input, value))| {
        let name = &input.name;
        format!(
            "input `{name}` is not driven and is taken as {value}; set it with {}",
            Argument::Inputs.with_entry(name, "...")
        )
    })
    .collect()
}

/// Returns the model without controllers, with one input replaced by a definition.
///
/// # Errors
/// An input that a controller drives; see also [`with_prescribed_inputs`].
pub(crate) fn with_one_prescribed_input(model: &Model, given: &Assignment) -> Result<Model, Error> {
    let mut inputs = model.inputs.iter();
    let place = inputs.position(|input| input.name == given.name());
    if place.is_some_and(|place| model.is_controlled(place)) {
        let message = format!("a controller drives the input `{}`", given.name());
        let help = "remove this option, or the output of the controller";
        return Err(given.name_error(message, Some(help.to_owned())).into());
    }
    let alone = match model.controllers.is_empty() {
        true => model.clone(),
        false => {
            let edited = edit::apply(&model.source, &[Edit::RemoveControllers]);
            let edited = edited.map_err(|error| Error::Request(error.to_string()))?;
            eomgen_model_spec::check(model.source.with_text(edited))?.model
        }
    };
    with_prescribed_inputs(alone, std::slice::from_ref(given))
}

/// Returns the error of an input, with its location in the option's text.
fn prescription_error(error: &EditError, given: &Assignment, model: &Model) -> Error {
    let found = match error {
        EditError::Invalid(found) => given.relocated(found),
        EditError::Expression { text, diagnostic } => {
            let source = Source::new("", text.as_str());
            given.relocated(&Diagnostics::from_one(source, (**diagnostic).clone()))
        }
        EditError::MissingTerm { .. } => {
            Some(given.name_error(format_messages(error, given, model), None))
        }
        _ => None,
    };
    match found {
        Some(found) => Error::Specification(found),
        None => Error::Request(format!(
            "{} {}: {}",
            given.option(),
            given.text(),
            format_messages(error, given, model)
        )),
    }
}

/// Returns the messages of an edit without locations, because they refer to the edited text.
fn format_messages(error: &EditError, given: &Assignment, model: &Model) -> String {
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
                true => format!("it has none; remove {}", given.option()),
                false => format!("it has {}", inputs.join(", ")),
            });
            format!("the model has no input `{name}`; {cure}")
        }
        error => error.to_string(),
    }
}
