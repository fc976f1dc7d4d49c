//! Operating points given on the command line, initial states, and their JSON.

use eomgen_compiled_model::{
    CompiledModel, Departure, Equilibrium, EquilibriumRequest, Error as Failure, Instance,
    OperatingPoint, Setting,
};
use eomgen_model_spec::assignment::{Assignment, QuantityReader};
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::unit::Unit;
use eomgen_sim::inputs::HeldInputs;
use serde_json::{Map, Value, json};

use crate::arguments::{ModelFile, ParameterValues};
use crate::document::SCHEMA;
use crate::error::{Error, Result, warn};
use crate::model::{derive, load, orders};
use crate::motion::note_moved;
use crate::settings::{as_borrowed, split, with_settings};

/// Loads a specification with parameters set and derives it.
pub fn model(file: &ModelFile, parameters: &ParameterValues) -> Result<CompiledModel> {
    let model = with_settings(load(&file.spec)?.model, &parameters.set)?;
    let orders = orders(&model, file.order.text())?;
    derive(model, &orders)
}

/// Word of `--state` that selects the nearest equilibrium.
const TRIM: &str = "trim";

/// Reads every `NAME=EXPR` of an option. Returns names and values, in SI, of states, inputs and `t`.
pub fn values(run: &Instance<'_>, option: &str, assigned: &[String]) -> Result<Vec<(String, f64)>> {
    let (compiled, model) = (run.model(), run.model().model());
    let states = model.state_units(compiled.orders());
    let reader = QuantityReader::new(model).map_err(Error::Specification)?;
    let value = |given: &Assignment| -> Result<(String, f64)> {
        let unit = match compiled.find_setting(given.name()) {
            Ok(Setting::State(place)) => states[place].clone(),
            Ok(Setting::Input(place)) => model.inputs[place].unit.clone(),
            Ok(Setting::Time) => Unit::coherent(Dimension::TIME),
            Err(error) => {
                let unknown = given.name_error(error.to_string(), None);
                return Err(Error::Specification(unknown));
            }
        };
        let value = reader.read(given, &unit).map_err(Error::Specification)?;
        Ok((given.name().to_owned(), value))
    };
    split(option, assigned)?.iter().map(value).collect()
}

/// Splits the values of `--state` into assignments, in SI, and whether the word `trim` is among them.
fn assignments(run: &Instance<'_>, state: &[String]) -> Result<(Vec<(String, f64)>, bool)> {
    let (words, assigned): (Vec<String>, Vec<String>) =
        state.iter().cloned().partition(|text| text.trim() == TRIM);
    Ok((values(run, "--state", &assigned)?, !words.is_empty()))
}

/// Returns the point of `--state`: the initial state with every `NAME=EXPR`, moved onto the constraints, or
/// the nearest equilibrium.
pub fn point(run: &Instance<'_>, state: &[String]) -> Result<OperatingPoint> {
    let (given, is_trimmed) = assignments(run, state)?;
    let given = as_borrowed(&given);
    match is_trimmed {
        false => consistent(run, run.operating_point(&given)?),
        true => Ok(equilibrium_near(run, &given)?.point),
    }
}

fn equilibrium_near(run: &Instance<'_>, start: &[(&str, f64)]) -> Result<Equilibrium> {
    let fixed = &[];
    equilibrium(
        run,
        EquilibriumRequest {
            start_values: start,
            fixed_values: fixed,
        },
    )
}

/// Finds an equilibrium; the command fails if there is none.
pub fn equilibrium(run: &Instance<'_>, request: EquilibriumRequest<'_>) -> Result<Equilibrium> {
    match run.find_equilibrium(request) {
        Err(Failure::Stopped { reason, .. }) => Err(Error::Stopped(reason)),
        Err(other) => Err(other.into()),
        Ok(found) => {
            if !found.nonzero_rates.is_empty() {
                let rates = found.nonzero_rates.join(", ");
                warn(&format!(
                    "note: the equilibrium is a steady motion, not rest: {rates} are constant"
                ));
            }
            if found.depends_on_time {
                warn(&format!(
                    "warning: the forces depend on time: the state is an equilibrium at t = {} s only",
                    found.point.t
                ));
            }
            Ok(found)
        }
    }
}

/// Returns whether a point is an equilibrium, and warns if it is not.
pub fn is_equilibrium(run: &Instance<'_>, at: &OperatingPoint) -> Result<bool> {
    let found = run.find_departure(at)?;
    if !found.is_none() {
        warn(&format!(
            "warning: this state is no equilibrium: {}; the linearisation holds for a short time only; \
             give another state with --state NAME=EXPR, or --state trim",
            describe(&found)
        ));
    }
    Ok(found.is_none())
}

/// Names the quantities that change at a state that is no equilibrium.
fn describe(found: &Departure) -> String {
    let parts = [
        ("the machine moves", &found.moving_rates, "is not 0"),
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

/// Returns the initial state with every `NAME=EXPR` of `--state`, or the nearest equilibrium.
pub fn initial_state(run: &Instance<'_>, state: &[String]) -> Result<Vec<f64>> {
    let (given, is_trimmed) = assignments(run, state)?;
    for (name, _) in &given {
        if !matches!(run.model().find_setting(name)?, Setting::State(_)) {
            return Err(Error::input(format!(
                "--state {name}: expected a coordinate, a mode, a rate or another state"
            )));
        }
    }
    let given = as_borrowed(&given);
    match is_trimmed {
        false => Ok(run.operating_point(&given)?.state),
        true => Ok(equilibrium_near(run, &given)?.point.state),
    }
}

/// Moves a point onto the constraints of the model, with a note about the states that moved.
fn consistent(run: &Instance<'_>, mut at: OperatingPoint) -> Result<OperatingPoint> {
    let inputs = HeldInputs::constant(at.inputs.clone());
    let (state, moved) = run.find_consistent_state(&at.state, at.t, &inputs)?;
    note_moved("state", &moved);
    at.state = state;
    Ok(at)
}

/// Returns the head of a document: schema, model, order.
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

/// Returns the names of the amplitudes of a mode shape: coordinates, then first-order states.
pub fn shape_names(compiled: &CompiledModel) -> Vec<String> {
    let (mut names, degrees) = (
        compiled.state_names(),
        compiled.program().degrees_of_freedom(),
    );
    names.drain(degrees..2 * degrees);
    names
}

/// Returns the units of the amplitudes of a mode shape.
pub fn shape_units(compiled: &CompiledModel) -> Vec<String> {
    let degrees = compiled.program().degrees_of_freedom();
    let mut units = compiled.state_units();
    units.drain(degrees..2 * degrees);
    units
}
