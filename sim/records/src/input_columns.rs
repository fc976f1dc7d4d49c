//! Names of input columns.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quote};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::suggest::did_you_mean;

use crate::description::Description;

/// Reports input columns that no input of the model has, if an input of the model has no column and nothing else drives
/// it: one of their names is probably wrong. `driven` are names of inputs that need no column.
pub fn check_input_names(
    description: &Description,
    (model, driven): (&Model, &[&str]),
    found: &mut Diagnostics,
) {
    let is_driven = |place: usize| {
        let name = &model.inputs[place].name;
        let is_fed = (description.inputs.iter()).any(|column| column.name.text == *name);
        let is_measured = (description.channels.iter()).any(|c| c.quantity_name() == name);
        is_fed || is_measured || model.is_controlled(place) || driven.contains(&name.as_str())
    };
    let inputs = model.inputs.iter().enumerate();
    let undriven = inputs.filter(|(place, input)| input.rate_of.is_none() && !is_driven(*place));
    let undriven: Vec<&str> = undriven.map(|(_, input)| input.name.as_str()).collect();
    for column in &description.inputs {
        let name = &column.name;
        if undriven.is_empty() || model.inputs.iter().any(|input| input.name == name.text) {
            continue;
        }
        let meant = did_you_mean(&name.text, undriven.iter().copied());
        let listed = match &undriven[..] {
            [only] => format!("its input without a column is `{only}`: write [inputs.{only}]"),
            several => format!("its inputs without a column are {}", several.join(", ")),
        };
        let help = format!(
            "{}; remove the table if the model needs no such input",
            meant.unwrap_or(listed)
        );
        found.push(
            Diagnostic::error(format!("the model has no input {}", quote(&name.text)))
                .with_span(name.span, "its column would drive nothing")
                .with_help(help),
        );
    }
}
