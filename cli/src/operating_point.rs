//! Operating points and initial states from the command line, and their JSON.

use eomgen_compiled_model::{
    CompiledModel, Departure, Equilibrium, EquilibriumRequest, Error as Failure, Instance,
    OperatingPoint, StateRequest,
};
use eomgen_sim::inputs::HeldInputs;
use serde_json::{Map, Value, json};

use crate::arguments::{ModelFile, ParameterValues};
use crate::document::SCHEMA;
use crate::error::{Error, Result, warn};
use crate::model::{derive, load, orders};
use crate::motion::note_moved;
use crate::settings::with_settings;

/// Loads a specification, sets parameters and derives the equations.
pub fn model(file: &ModelFile, parameters: &ParameterValues) -> Result<CompiledModel> {
    let model = with_settings(load(&file.spec)?.model, &parameters.set)?;
    if let Some(controller) = model.controllers.first() {
        warn(&format!(
            "note: the controllers of the model (`{}`) are not part of its equations; the inputs that they drive are \
             free here",
            controller.name
        ));
    }
    let orders = orders(&model, file.order.text())?;
    derive(model, &orders)
}

/// Returns the operating point of `--state`: the initial state, changed by every `NAME=EXPR` and projected onto the
/// constraints, or the nearest equilibrium.
pub fn point(run: &Instance<'_>, state: &[String]) -> Result<OperatingPoint> {
    let request = StateRequest::parse("--state", state)?;
    match require_result(run.requested_point(&request))? {
        (point, None) => consistent(run, point),
        (point, Some(equilibrium)) => {
            report_equilibrium(&equilibrium);
            Ok(point)
        }
    }
}

/// Finds an equilibrium; the command fails if there is none.
pub fn equilibrium(run: &Instance<'_>, request: EquilibriumRequest<'_>) -> Result<Equilibrium> {
    let found = require_result(run.find_equilibrium(request))?;
    report_equilibrium(&found);
    Ok(found)
}

/// Converts a failed search to a negative result of the command.
fn require_result<T>(result: std::result::Result<T, Failure>) -> Result<T> {
    result.map_err(|error| match error {
        Failure::Stopped { reason, .. } => Error::Stopped(reason),
        other => other.into(),
    })
}

/// Prints a note about a steady motion and a warning about forces that depend on time.
fn report_equilibrium(found: &Equilibrium) {
    if !found.nonzero_rates.is_empty() {
        let rates = found.nonzero_rates.join(", ");
        let verb = if found.nonzero_rates.len() == 1 {
            "is"
        } else {
            "are"
        };
        warn(&format!(
            "note: the equilibrium is a steady motion, not rest: {rates} {verb} constant"
        ));
    }
    if found.depends_on_time {
        warn(&format!(
            "warning: the forces depend on time, or prescribed motion moves: the state is an equilibrium at t = {} s \
             only",
            found.point.t
        ));
    }
}

/// Returns true if a point is an equilibrium; otherwise prints a warning with `consequence`.
pub fn is_equilibrium(run: &Instance<'_>, at: &OperatingPoint, consequence: &str) -> Result<bool> {
    let found = run.find_departure(at)?;
    if !found.is_none() {
        warn(&format!(
            "warning: this state is not an equilibrium: {}; {consequence}; give another state with --state NAME=EXPR, \
             or --state trim",
            describe(&found)
        ));
    }
    Ok(found.is_none())
}

/// Describes the quantities that change at a state that is not an equilibrium.
fn describe(found: &Departure) -> String {
    let parts = [
        ("the machine moves", &found.moving_rates, "is not 0"),
        ("prescribed motion moves", &found.moving_inputs, "is not 0"),
        (
            "the machine accelerates",
            &found.accelerating_rates,
            "changes",
        ),
        (
            "a first-order state changes",
            &found.changing_states,
            "changes",
        ),
    ];
    let parts = parts.iter().filter(|(_, names, _)| !names.is_empty());
    let parts: Vec<String> = parts
        .map(|(what, names, verb)| match &names[..] {
            [name] => format!("{what} ({name} {verb})"),
            names => format!("{what} ({})", names.join(", ")),
        })
        .collect();
    parts.join(" and ")
}

/// Returns the initial state, changed by every `NAME=EXPR` of `--state`, or the nearest equilibrium.
pub fn initial_state(run: &Instance<'_>, state: &[String]) -> Result<Vec<f64>> {
    let request = StateRequest::parse("--state", state)?;
    let (state, equilibrium) = require_result(run.requested_state(&request))?;
    if let Some(equilibrium) = &equilibrium {
        report_equilibrium(equilibrium);
    }
    Ok(state)
}

/// Projects a point onto the constraints of the model and prints a note about the changed states.
fn consistent(run: &Instance<'_>, mut at: OperatingPoint) -> Result<OperatingPoint> {
    let inputs = HeldInputs::constant(at.inputs.clone());
    let (state, moved) = run.find_consistent_state(&at.state, at.t, &inputs)?;
    note_moved("state", &moved);
    at.state = state;
    Ok(at)
}

/// Returns the first entries of a document: schema, model, order.
pub fn head(compiled: &CompiledModel) -> Map<String, Value> {
    let mut document = Map::new();
    document.insert("schema".to_owned(), json!(SCHEMA));
    document.insert("model".to_owned(), json!(compiled.model().name));
    let order = match compiled.orders() {
        [] => json!(0),
        [one] => json!(one),
        several => json!(several),
    };
    document.insert("order".to_owned(), order);
    document
}

/// Returns time, state and inputs by name, in SI.
pub fn values_by_name(compiled: &CompiledModel, at: &OperatingPoint) -> Value {
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

/// Returns names and SI units of the inputs.
pub fn inputs(compiled: &CompiledModel) -> (Vec<&str>, Vec<String>) {
    let inputs = compiled.model().inputs.iter();
    inputs
        .map(|input| (&*input.name, input.unit.to_string()))
        .unzip()
}
