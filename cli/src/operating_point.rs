//! Operating points on the command line: a model of given orders and parameters, where it is
//! linearised or where a motion begins, and its JSON.

use std::path::Path;

use eomgen_compiled_model::{
    CompiledModel, Departure, Equilibrium, EquilibriumRequest, Error as Failure, Instance,
    OperatingPoint, Setting,
};
use eomgen_model_spec::assignment::{Assignment, QuantityReader};
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::unit::Unit;
use eomgen_sim::inputs::HeldInputs;
use serde_json::{Map, Value, json};

use crate::error::{Error, Result, warn};
use crate::model::{derive, load, orders};
use crate::motion::note_moved;
use crate::settings::{borrowed, split, with_settings};

/// The model of a specification with parameters set.
pub fn model(spec: &Path, order: Option<&str>, set: &[String]) -> Result<CompiledModel> {
    let model = with_settings(load(spec)?.model, set)?;
    let orders = orders(&model, order)?;
    derive(model, &orders)
}

/// The word in place of an assignment for the nearest equilibrium.
const TRIM: &str = "trim";

/// Names and values of every `NAME=VALUE` of an option: states, inputs and `t`, in SI.
pub fn values(run: &Instance<'_>, option: &str, assigned: &[String]) -> Result<Vec<(String, f64)>> {
    let (compiled, model) = (run.model(), run.model().model());
    let states = model.state_units(compiled.orders());
    let reader = QuantityReader::new(model).map_err(Error::Specification)?;
    let value = |given: &Assignment| -> Result<(String, f64)> {
        let unit = match compiled.setting(given.name()) {
            Ok(Setting::State(place)) => states[place].clone(),
            Ok(Setting::Input(place)) => model.inputs[place].unit.clone(),
            Ok(Setting::Time) => Unit::coherent(Dimension::TIME),
            Err(error) => {
                let unknown = given.refuse_name(error.to_string(), None);
                return Err(Error::Specification(unknown));
            }
        };
        let value = reader.read(given, &unit).map_err(Error::Specification)?;
        Ok((given.name().to_owned(), value))
    };
    split(option, assigned)?.iter().map(value).collect()
}

/// The point of `--at`: the initial state with every `NAME=VALUE`, on the constraints; with the word `trim`
/// the equilibrium nearest to it.
pub fn point(run: &Instance<'_>, at: &[String]) -> Result<OperatingPoint> {
    let (words, assigned): (Vec<String>, Vec<String>) =
        at.iter().cloned().partition(|text| text.trim() == TRIM);
    let given = values(run, "--at", &assigned)?;
    let given = borrowed(&given);
    match words.is_empty() {
        true => consistent(run, run.operating_point(&given)?),
        false => {
            let request = EquilibriumRequest {
                start: &given,
                fixed: &[],
            };
            Ok(equilibrium(run, request)?.at)
        }
    }
}

/// An equilibrium; the command fails if there is none.
pub fn equilibrium(run: &Instance<'_>, request: EquilibriumRequest<'_>) -> Result<Equilibrium> {
    match run.equilibrium(request) {
        Err(Failure::Stopped { reason, .. }) => {
            warn(&format!("error: {reason}"));
            Err(Error::Failed)
        }
        Err(other) => Err(other.into()),
        Ok(found) => {
            if !found.running.is_empty() {
                let rates = found.running.join(", ");
                warn(&format!(
                    "note: this is not rest but steady running: {rates} are constant"
                ));
            }
            if found.depends_on_time {
                warn(&format!(
                    "warning: the forces depend on the time: this is an equilibrium at t = {} s alone",
                    found.at.t
                ));
            }
            Ok(found)
        }
    }
}

/// Whether a point is an equilibrium, with a warning if it is not.
pub fn is_equilibrium(run: &Instance<'_>, at: &OperatingPoint) -> Result<bool> {
    let found = run.departure(at)?;
    if !found.is_none() {
        warn(&format!(
            "warning: this state is no equilibrium: {}, and what is linearised holds for a short time only; \
             give another state with --at NAME=VALUE, or --at trim",
            described(&found)
        ));
    }
    Ok(found.is_none())
}

/// Says which quantities change at a state that is no equilibrium.
fn described(found: &Departure) -> String {
    let parts = [
        ("the machine moves there", &found.moving, "is not 0"),
        (
            "the machine accelerates there",
            &found.accelerating,
            "changes",
        ),
        ("a state changes there", &found.changing, "changes"),
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

/// The initial state with every `NAME=VALUE`.
pub fn with_initial(run: &Instance<'_>, assigned: &[String]) -> Result<Vec<f64>> {
    let settings = values(run, "--initial", assigned)?;
    for (name, _) in &settings {
        if !matches!(run.model().setting(name)?, Setting::State(_)) {
            return Err(Error::input(format!(
                "--initial {name}: expected a coordinate, a mode or a rate"
            )));
        }
    }
    Ok(run.operating_point(&borrowed(&settings))?.state)
}

/// The point moved onto the constraints of the model, with a note of what that moved.
fn consistent(run: &Instance<'_>, mut at: OperatingPoint) -> Result<OperatingPoint> {
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
