//! `eomgen check`: reads a specification, checks it, and says what it holds.

use eomgen_compiled_model::CompiledModel;
use eomgen_model_spec::diagnostic::Diagnostics;
use serde_json::{Value, json};

use crate::arguments::Check;
use crate::error::{Error, Result, say, say_json, warn_of};
use crate::model::{derive, orders};

/// Runs the command. A derivation is part of the check: what cannot be derived is an
/// error of the specification too.
pub fn run(options: &Check) -> Result {
    let (compiled, warnings) = match examine(options) {
        Ok(found) => found,
        Err(error) => {
            if let (true, Error::Specification(found)) = (options.json, &error) {
                let document = json!({"passed": false, "diagnostics": found.records()});
                say_json(&document)?;
            }
            return Err(error);
        }
    };
    if options.json {
        return say_json(&record(&compiled, &warnings));
    }
    if !warnings.is_empty() {
        warn_of(&warnings);
    }
    say(&summary(&compiled))
}

fn examine(options: &Check) -> Result<(CompiledModel, Diagnostics)> {
    let checked = eomgen_model_spec::load(&options.spec).map_err(Error::Specification)?;
    let orders = orders(&checked.model, options.order.as_deref())?;
    Ok((derive(checked.model, &orders)?, checked.warnings))
}

fn record(compiled: &CompiledModel, warnings: &Diagnostics) -> Value {
    json!({
        "passed": true,
        "model": compiled.model().name,
        "orders": compiled.equations().graph.orders(),
        "state": compiled.program().state_names(),
        "diagnostics": warnings.records(),
    })
}

fn summary(compiled: &CompiledModel) -> String {
    let model = compiled.model();
    let fields = match compiled.equations().graph.orders() {
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
