//! Data for the script of the page, as JSON.

use eomgen_compiled_model::CompiledModel;
use eomgen_model_spec::model::{Drawing, Ordinate};
use eomgen_page::name_letters;
use eomgen_page::play::format_unit;
use serde_json::{Value, json};

use super::quantities::{Quantities, machine_size, rounding_error};
use crate::error::{Error, Result};
use crate::field_shapes::{FieldShapes, field_shapes};

/// Number of intervals along a field.
const INTERVALS: usize = 40;

/// Returns the data of a model with an initial state; `moving` is the data for simulating it.
pub(super) fn json(
    compiled: &CompiledModel,
    quantities: &Quantities<'_>,
    initial: &[f64],
    moving: Value,
) -> Result<String> {
    let program = compiled.program();
    let size = machine_size(compiled);
    let quantity = |name: &str, unit: &str| {
        json!({
            "symbol": name_letters(name),
            "unit": format_unit(unit),
            "noise": rounding_error(unit, size),
        })
    };
    let names = compiled.state_names().into_iter();
    let state = names.zip(&quantities.units).zip(initial);
    let state: Vec<Value> = state
        .map(|((name, unit), initial)| {
            let mut quantity = quantity(&name, unit);
            quantity["initial"] = json!(initial);
            quantity
        })
        .collect();
    let of = |observable: &eomgen_codegen::program::Quantity| {
        quantity(&observable.name, &observable.unit)
    };
    let inputs = program.inputs.iter().zip(compiled.default_inputs());
    let inputs = inputs.map(|(input, value)| json!({ "name": input.name, "value": value }));
    let fields = field_shapes(compiled, INTERVALS)?;
    let document = json!({
        "moving": moving,
        "parameters": program.default_parameters(),
        "state": state,
        "inputs": inputs.collect::<Vec<_>>(),
        "observables": program.observables.iter().map(of).collect::<Vec<_>>(),
        "coordinates": compiled.model().coordinates.len(),
        "fields": fields.iter().map(field).collect::<Vec<_>>(),
        "drawing": compiled.model().drawing.as_ref().map(drawing),
    });
    serde_json::to_string(&document).map_err(|error| Error::input(error.to_string()))
}

/// Returns a field with its mode shapes, one row for each position.
fn field(shapes: &FieldShapes<'_>) -> Value {
    let ends = shapes.positions.first().zip(shapes.positions.last());
    json!({
        "symbol": name_letters(&shapes.field.name),
        "unit": format_unit(&shapes.field.unit.to_string()),
        "along": shapes.field.along,
        "length": ends.map(|(from, to)| to - from),
        "first": shapes.first,
        "functions": shapes.functions,
    })
}

/// Returns the points of a drawing with their coordinates, and its lines with the indices of their points.
fn drawing(drawing: &Drawing) -> Value {
    let points = drawing.points.iter();
    let points: Vec<Value> = points
        .map(|point| {
            json!({
                "symbol": name_letters(&point.name),
                "x": ordinate(point.x),
                "y": ordinate(point.y),
            })
        })
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
