//! `eomgen linearise`: the matrices A, B, C, D of a model at a state.

use eomgen_compiled_model::CompiledModel;
use serde_json::json;

use crate::arguments::Linearise;
use crate::count::count;
use crate::document::SCHEMA;
use crate::error::{Result, print_bytes};
use crate::linearisation::{LinearModel, arrays, document};
use crate::operating_point::{is_equilibrium, model, point};
use crate::output::Destination;
use crate::regime::{note_surfaces, regime};

pub fn run(options: &Linearise) -> Result {
    let destination = options
        .out
        .as_deref()
        .map(|out| Destination::for_output(out, options.output.json));
    let destination = destination.transpose()?;
    let compiled = model(&options.model, &options.parameters)?;
    let run = compiled.with_declared_parameters()?;
    let at = point(&run, &options.point.state)?;
    let is_equilibrium = is_equilibrium(
        &run,
        &at,
        "the linearisation is valid for a short time only",
    )?;
    let found = run.linearise(at.point())?;
    if found.is_one_sided {
        note_surfaces(&regime(&run, &at)?);
    }
    let found = LinearModel::new(&compiled, found, options.discrete)?;
    let text = || {
        document(&compiled, (&at, is_equilibrium), &found).map(|document| format!("{document:#}\n"))
    };
    let Some(destination) = destination else {
        return print_bytes(text()?.as_bytes());
    };
    let extension = options.out.as_deref().and_then(|out| out.extension());
    let contents = match extension.is_some_and(|extension| extension == "npz") {
        true => arrays(&compiled, &at, &found)?,
        false => text()?.into_bytes(),
    };
    destination.write(&contents)?;
    destination.summarise(&summary(options, &compiled))
}

fn summary(options: &Linearise, compiled: &CompiledModel) -> String {
    let file = options.out.as_ref().map(|out| out.display().to_string());
    let file = file.unwrap_or_default();
    let states = compiled.program().states();
    let inputs = compiled.model().inputs.len();
    let outputs = compiled.program().observables.len();
    if options.output.json {
        let document = json!({
            "schema": SCHEMA,
            "file": file,
            "states": states,
            "inputs": inputs,
            "outputs": outputs,
        });
        return format!("{document:#}\n");
    }
    format!(
        "{file}: {}, {}, {}\n",
        count(states, "state"),
        count(inputs, "input"),
        count(outputs, "output")
    )
}
