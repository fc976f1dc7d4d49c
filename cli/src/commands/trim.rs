//! `eomgen trim`: an equilibrium of a model and its stability.

use eomgen_compiled_model::{
    CompiledModel, Equilibrium, EquilibriumRequest, Stability, split_assignments,
};
use serde_json::{Value, json};

use crate::arguments::Trim;
use crate::error::{Result, print_json, print_text};
use crate::operating_point::{equilibrium, head, inputs, model, values_by_name};
use crate::settings::as_borrowed;
use crate::significant::significant;

pub fn run(options: &Trim) -> Result {
    let compiled = model(&options.model, &options.parameters)?;
    let run = compiled.with_declared_parameters()?;
    let start = run.read_quantities(&split_assignments("--state", &options.start.state)?)?;
    let fixed = run.read_quantities(&split_assignments("--fix", &options.fix)?)?;
    let request = EquilibriumRequest {
        start_values: &as_borrowed(&start),
        fixed_values: &as_borrowed(&fixed),
    };
    let found = equilibrium(&run, request)?;
    let stability = run.classify_stability(&found.point)?;
    match options.table {
        true => print_text(&table(&compiled, &found, stability)),
        false => print_json(&document(&compiled, &found, stability)),
    }
}

/// Returns the coordinates, the rates of a steady motion, the first-order states and the inputs, each
/// with its unit, and the stability.
fn table(compiled: &CompiledModel, found: &Equilibrium, stability: Stability) -> String {
    let degrees = compiled.program().degrees_of_freedom();
    let states = compiled.state_names().into_iter();
    let states = states
        .zip(compiled.state_units())
        .zip(&found.point.state)
        .enumerate();
    let states = states.filter(|(place, ((name, _), _))| {
        !(degrees..2 * degrees).contains(place) || found.nonzero_rates.contains(name)
    });
    let states = states.map(|(_, ((name, unit), value))| (name, unit, *value));
    let (names, units) = inputs(compiled);
    let inputs = names.into_iter().zip(units).zip(&found.point.inputs);
    let inputs = inputs.map(|((name, unit), value)| (name.to_owned(), unit, *value));
    let rows: Vec<(String, String, f64)> = states.chain(inputs).collect();
    let widest = rows.iter().map(|(name, ..)| name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for (name, unit, value) in rows {
        let solved = match found.unknowns.contains(&name) {
            true => "",
            false => "   (fixed)",
        };
        text += &format!("{name:<widest$}   {} {unit}{solved}\n", significant(value));
    }
    text + &format!("{stability}\n")
}

fn document(compiled: &CompiledModel, found: &Equilibrium, stability: Stability) -> Value {
    let states = compiled.state_names();
    let degrees = compiled.program().degrees_of_freedom();
    let coordinates = &states[..degrees];
    let (inputs, input_units) = inputs(compiled);
    let units = &compiled.state_units()[..coordinates.len()];
    let mut document = head(compiled);
    document.extend([
        ("at".to_owned(), values_by_name(compiled, &found.point)),
        ("coordinates".to_owned(), json!(coordinates)),
        ("inputs".to_owned(), json!(inputs)),
        (
            "units".to_owned(),
            json!({ "coordinates": units, "inputs": input_units }),
        ),
        ("free".to_owned(), json!(found.unknowns)),
        ("steady_rates".to_owned(), json!(found.nonzero_rates)),
        ("residual".to_owned(), json!(found.residual)),
        ("stability".to_owned(), json!(stability.to_string())),
    ]);
    Value::Object(document)
}
