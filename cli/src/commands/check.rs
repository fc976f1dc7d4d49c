//! `eomgen check`: reads a specification, checks it, and says what it holds.

use std::io::IsTerminal;

use model_spec::diagnostic::Diagnostics;
use serde_json::{Value, json};

use crate::arguments::Check;
use crate::problem::{Outcome, Problem, say, warn};
use crate::variant::{Variant, derive_variant, orders};

/// Runs the command. A derivation is part of the check: what cannot be derived is an
/// error of the specification too.
pub fn run(options: &Check) -> Outcome {
    let (variant, warnings) = match examine(options) {
        Ok(found) => found,
        Err(problem) => {
            if let (true, Problem::Specification(found)) = (options.json, &problem) {
                let document = json!({"passed": false, "diagnostics": found.records()});
                say(&format!("{document:#}\n"))?;
            }
            return Err(problem);
        }
    };
    if options.json {
        return say(&format!("{:#}\n", record(&variant, &warnings)));
    }
    if !warnings.is_empty() {
        warn(&warnings.render(std::io::stderr().is_terminal()));
    }
    say(&summary(&variant))
}

fn examine(options: &Check) -> Outcome<(Variant, Diagnostics)> {
    let checked = model_spec::load(&options.spec).map_err(Problem::Specification)?;
    let orders = orders(&checked.model, options.order.as_deref())?;
    Ok((derive_variant(checked.model, &orders)?, checked.warnings))
}

fn record(variant: &Variant, warnings: &Diagnostics) -> Value {
    json!({
        "passed": true,
        "model": variant.model.name,
        "orders": variant.equations.graph.orders(),
        "state": variant.program.state_names(),
        "diagnostics": warnings.records(),
    })
}

fn summary(variant: &Variant) -> String {
    let model = &variant.model;
    let fields = match variant.equations.graph.orders() {
        [] => "no field".to_owned(),
        orders => {
            let list: Vec<String> = orders.iter().map(usize::to_string).collect();
            format!("order {}", list.join(", "))
        }
    };
    format!(
        "{}: parameters {}, coordinates {}, {fields}, energy terms {}, forces {}, observables {}; names and units agree\n",
        model.name,
        model.parameters.len(),
        model.coordinates.len(),
        model.kinetic.len() + model.potential.len(),
        model.forces.len() + model.dissipation.len(),
        model.observables.len() + 2,
    )
}
