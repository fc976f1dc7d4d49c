//! Input of the script, as JSON.

use eomgen_compiled_model::CompiledModel;
use eomgen_model_spec::model::{Drawing, Ordinate};
use eomgen_page::play::{encode_base64, format_unit};
use serde_json::{Value, json};

use super::quantities::Quantities;
use crate::error::{Error, Result};

/// Returns the data of a model with an initial state and its WebAssembly module.
pub(super) fn json(
    compiled: &CompiledModel,
    quantities: &Quantities<'_>,
    initial: &[f64],
    module: &[u8],
) -> Result<String> {
    let program = compiled.program();
    let names = compiled.state_names().into_iter();
    let state = names.zip(&quantities.units).zip(initial);
    let state: Vec<Value> = state
        .map(|((name, unit), initial)| json!({ "name": name, "unit": format_unit(unit), "initial": initial }))
        .collect();
    let of = |quantity: &eomgen_codegen::program::Quantity| json!({ "name": quantity.name, "unit": format_unit(&quantity.unit) });
    let inputs = program.inputs.iter().zip(compiled.default_inputs());
    let inputs = inputs.map(|(input, value)| {
        json!({ "name": input.name, "unit": format_unit(&input.unit), "value": value })
    });
    let evaluator = compiled.evaluator(&program.default_parameters());
    let document = json!({
        "module": encode_base64(module),
        "parameters": program.default_parameters(),
        "state": state,
        "inputs": inputs.collect::<Vec<_>>(),
        "observables": program.observables.iter().map(of).collect::<Vec<_>>(),
        "guards": evaluator.guard_count(),
        "drawing": compiled.model().drawing.as_ref().map(drawing),
    });
    serde_json::to_string(&document).map_err(|error| Error::input(error.to_string()))
}

/// Returns points with their coordinates, and lines with the indices of their points.
fn drawing(drawing: &Drawing) -> Value {
    let points = drawing.points.iter();
    let points: Vec<Value> = points
        .map(|point| json!({ "x": ordinate(point.x), "y": ordinate(point.y) }))
        .collect();
    let lines = drawing.lines.iter();
    let lines: Vec<Vec<usize>> = lines
        .map(|line| line.points.iter().map(|point| point.index()).collect())
        .collect();
    json!({ "points": points, "lines": lines })
}

fn ordinate(ordinate: Ordinate) -> Value {
    match ordinate {
        Ordinate::Number(number) => json!({ "number": number }),
        Ordinate::Coordinate(id) => json!({ "state": id.index() }),
        Ordinate::Observable(id) => json!({ "observable": id.index() }),
    }
}
