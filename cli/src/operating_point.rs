//! Operating points on the command line: a model of given orders and parameters, where it is
//! linearised or where a motion begins, and how JSON says it.

use std::path::Path;

use eomgen_compiled_model::{CompiledModel, Instance, OperatingPoint, Setting};
use eomgen_sim::inputs::HeldInputs;
use serde_json::{Map, Value, json};

use crate::error::{Error, Result};
use crate::model::{derive, load, orders};
use crate::motion::note_moved;
use crate::settings::with_settings;

/// The model of a specification with parameters set.
pub fn model(spec: &Path, order: Option<&str>, set: &[String]) -> Result<CompiledModel> {
    let model = with_settings(load(spec)?.model, set)?;
    let orders = orders(&model, order)?;
    derive(model, &orders)
}

/// Names and numbers of every `NAME=VALUE` of an option, in SI.
pub fn assignments<'a>(option: &str, assigned: &'a [String]) -> Result<Vec<(&'a str, f64)>> {
    assigned
        .iter()
        .map(|text| assignment(option, text))
        .collect()
}

fn assignment<'a>(option: &str, text: &'a str) -> Result<(&'a str, f64)> {
    let wrong = |what: &str| Error::input(format!("{option} {text}: {what}"));
    let (name, value) = text.split_once('=').ok_or_else(|| {
        wrong("expected NAME=VALUE, the name of a coordinate, a rate (NAME_dot) or an input, the value in SI")
    })?;
    let number: f64 = value
        .trim()
        .parse()
        .map_err(|_| wrong(&format!("\"{value}\" is no number")))?;
    Ok((name.trim(), number))
}

/// The initial state with every `NAME=VALUE`.
pub fn with_initial(run: &Instance<'_>, assigned: &[String]) -> Result<Vec<f64>> {
    let settings = assignments("--initial", assigned)?;
    for (name, _) in &settings {
        if !matches!(run.model().setting(name)?, Setting::State(_)) {
            return Err(Error::input(format!(
                "--initial {name}: expected a coordinate, a mode or a rate"
            )));
        }
    }
    Ok(run.operating_point(&settings)?.state)
}

/// The point moved onto the constraints of the model, with a note of what that moved.
pub fn consistent(run: &Instance<'_>, mut at: OperatingPoint) -> Result<OperatingPoint> {
    let inputs = HeldInputs::constant(at.inputs.clone());
    let (state, moved) = run.consistent(&at.state, at.t, &inputs)?;
    note_moved("state", &moved);
    at.state = state;
    Ok(at)
}

/// The head of a document: schema, model, order; with the names and SI units of what it is about.
pub fn head(compiled: &CompiledModel) -> Map<String, Value> {
    let mut document = Map::new();
    document.insert("schema".to_owned(), json!(1));
    document.insert("model".to_owned(), json!(compiled.model().name));
    let order = match compiled.orders() {
        [] => json!(0),
        [one] => json!(one),
        several => json!(several),
    };
    document.insert("order".to_owned(), order);
    document
}

/// A time, a state and inputs by name, SI.
pub fn named(compiled: &CompiledModel, at: &OperatingPoint) -> Value {
    let mut values = Map::new();
    values.insert("t".to_owned(), json!(at.t));
    for (name, value) in compiled.state_names().into_iter().zip(&at.state) {
        values.insert(name, json!(value));
    }
    for (input, value) in compiled.model().inputs.iter().zip(&at.inputs) {
        values.insert(input.name.clone(), json!(value));
    }
    Value::Object(values)
}

/// Names and SI units of the inputs.
pub fn inputs(compiled: &CompiledModel) -> (Vec<&str>, Vec<String>) {
    let inputs = compiled.model().inputs.iter();
    inputs
        .map(|input| (&*input.name, input.unit.to_string()))
        .unzip()
}

/// What the numbers of a shape are amplitudes of: coordinates, then states of first order.
pub fn shape_names(compiled: &CompiledModel) -> Vec<String> {
    let (mut names, degrees) = (
        compiled.state_names(),
        compiled.program().degrees_of_freedom(),
    );
    names.drain(degrees..2 * degrees);
    names
}
