//! Records of machines under feedback.

use std::path::Path;

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::edit::{self, Edit};
use eomgen_model_spec::model::{Controller, Model};

use crate::description::Description;
use crate::refusal::Refusal;

/// Returns a model without its controllers, and a note about this. In a comparison their recorded outputs then drive
/// the machine. A model without controllers is returned unchanged.
///
/// # Errors
/// An invalid dataset file, or an output without a column.
pub fn open_loop(model: Model, dataset: &Path) -> Result<(Model, Option<String>), Refusal> {
    if model.controllers.is_empty() {
        return Ok((model, None));
    }
    let description = Description::read(dataset, &model)?;
    let mut driven = Vec::new();
    for controller in &model.controllers {
        for output in &controller.outputs {
            let name = &model.inputs[output.input].name;
            if !is_recorded(&description, name) {
                let found = missing_column(controller, name).with_span(output.span, "driven here");
                return Err(Diagnostics::from_one(model.source.clone(), found).into());
            }
            driven.push(format!("`{name}`"));
        }
    }
    let alone = edit::apply(&model.source, &[Edit::RemoveControllers]);
    let alone = alone.map_err(|error| Refusal::Record(error.to_string()))?;
    let alone = eomgen_model_spec::check(model.source.with_text(alone))?.model;
    let controllers = model
        .controllers
        .iter()
        .map(|known| format!("`{}`", known.name));
    let controllers = controllers.collect::<Vec<_>>().join(", ");
    let note = match driven.is_empty() {
        true => format!("the controllers ({controllers}) drive no input and are left out"),
        false => format!(
            "the recorded {} drive the machine: its controllers ({controllers}) are left out",
            driven.join(", ")
        ),
    };
    Ok((alone, Some(note)))
}

/// Returns true if the records give an input. With given motion, channels measure the inputs.
fn is_recorded(description: &Description, name: &str) -> bool {
    let mut inputs = description.inputs.iter();
    let mut channels = description.channels.iter();
    inputs.any(|column| column.name.text == *name)
        || (!description.motion.is_empty()
            && channels.any(|channel| channel.quantity_name() == name))
}

fn missing_column(controller: &Controller, input: &str) -> Diagnostic {
    Diagnostic::error(format!(
        "the records have no column for the input `{input}`, which the controller `{}` drives",
        controller.name
    ))
    .with_help(format!(
        "add [inputs.{input}] with the recorded output to the dataset file: it then drives the machine. A controller \
         cannot be simulated there, because its states at the start of a window are unknown"
    ))
}
