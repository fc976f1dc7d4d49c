//! `eomgen check`: reads a specification, checks it, and says what it holds.

use serde_json::json;

use crate::arguments::Check;
use crate::problem::{Outcome, Problem, say};
use crate::variant::{derive_variant, orders};

/// Runs the command. A derivation is part of the check: what cannot be derived is an
/// error of the specification too.
pub fn run(options: &Check) -> Outcome {
    let checked = match model_spec::load(&options.spec) {
        Ok(checked) => checked,
        Err(diagnostics) => {
            if options.json {
                say(&format!("{:#}\n", json!({"passed": false, "diagnostics": diagnostics.records()})))?;
            }
            return Err(Problem::Specification(diagnostics));
        }
    };
    let warnings = checked.warnings;
    let orders = orders(&checked.model, options.order.as_deref())?;
    let variant = derive_variant(checked.model, &orders)?;
    let model = &variant.model;
    if options.json {
        let document = json!({
            "passed": true,
            "model": model.name,
            "orders": orders,
            "state": variant.program.state_names(),
            "diagnostics": warnings.records(),
        });
        return say(&format!("{document:#}\n"));
    }
    if !warnings.is_empty() {
        eprintln!("{}", warnings.render(std::io::IsTerminal::is_terminal(&std::io::stderr())));
    }
    let fields = match orders.as_slice() {
        [] => "no field".to_owned(),
        orders => {
            let list: Vec<String> = orders.iter().map(usize::to_string).collect();
            format!("order {}", list.join(", "))
        }
    };
    say(&format!(
        "{}: {} parameters, {} coordinates, {fields}, {} energy terms, {} forces, {} observables; names and units agree\n",
        model.name,
        model.parameters.len(),
        model.coordinates.len(),
        model.kinetic.len() + model.potential.len(),
        model.forces.len() + model.dissipation.len(),
        model.observables.len() + 2,
    ))
}
