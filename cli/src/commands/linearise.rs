//! `eomgen linearise`: the matrices A, B, C, D of a model about a state.

use eomgen_compiled_model::{CompiledModel, Linearisation, OperatingPoint};
use serde_json::{Value, json};

use crate::arguments::Linearise;
use crate::error::{Result, say};
use crate::operating_point::{assignments, head, inputs, linearised, model, named};
use crate::output::Destination;

/// Runs the command.
pub fn run(options: &Linearise) -> Result {
    let destination = options
        .out
        .as_deref()
        .map(|out| Destination::of(out, false));
    let destination = destination.transpose()?;
    let compiled = model(&options.spec, options.order.as_deref(), &options.set)?;
    let run = compiled.at_declared()?;
    let at = run.operating_point(&assignments("--at", &options.at)?)?;
    let found = linearised(&run, &at)?;
    let text = format!("{:#}\n", document(&compiled, &at, &found));
    match destination {
        None => say(&text),
        Some(destination) => {
            destination.write(text.as_bytes())?;
            destination.summarise(&summary(options, &compiled))
        }
    }
}

fn document(compiled: &CompiledModel, at: &OperatingPoint, found: &Linearisation) -> Value {
    let (inputs, input_units) = inputs(compiled);
    let observables = &compiled.program().observables;
    let output_units: Vec<&str> = observables.iter().map(|known| &*known.unit).collect();
    let states = compiled.state_names();
    // A matrix without columns still has its rows.
    let of = |matrix: &[f64], height: usize, columns: usize| match columns {
        0 => json!(vec![Vec::<f64>::new(); height]),
        _ => matrix.chunks(columns).map(|row| json!(row)).collect(),
    };
    let (n, m, l) = (states.len(), inputs.len(), observables.len());
    let mut document = head(compiled);
    document.extend([
        ("at".to_owned(), named(compiled, at)),
        ("states".to_owned(), json!(states)),
        ("inputs".to_owned(), json!(inputs)),
        ("outputs".to_owned(), json!(compiled.observable_names())),
        (
            "units".to_owned(),
            json!({ "states": compiled.state_units(), "inputs": input_units, "outputs": output_units }),
        ),
        ("rates".to_owned(), json!(found.rates)),
        ("A".to_owned(), of(&found.a, n, n)),
        ("B".to_owned(), of(&found.b, n, m)),
        ("C".to_owned(), of(&found.c, l, n)),
        ("D".to_owned(), of(&found.d, l, m)),
    ]);
    Value::Object(document)
}

fn summary(options: &Linearise, compiled: &CompiledModel) -> String {
    let file = options.out.as_ref().map(|out| out.display().to_string());
    format!(
        "{}: {} states, {} inputs, {} outputs\n",
        file.unwrap_or_default(),
        compiled.program().states(),
        compiled.model().inputs.len(),
        compiled.program().observables.len()
    )
}
