//! `eomgen check`: diagnostics and a summary of a specification.

use eomgen_codegen::variant::examine;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::Model;
use serde_json::{Value, json};

use crate::arguments::Check;
use crate::document::SCHEMA;
use crate::error::{Error, Result, print_diagnostics, print_json, print_text};
use crate::model::{note_redundancy, orders, read};

/// Checked model with the orders of its fields, warnings and notes.
struct CheckedModel {
    model: Model,
    orders: Vec<usize>,
    warnings: Diagnostics,
    /// Notes about dependent constraints.
    notes: Vec<String>,
}

pub fn run(options: &Check) -> Result {
    let examined = match examine_specification(options) {
        Ok(found) => found,
        Err(error) => {
            if let (true, Some(mut document)) = (options.output.json, error.to_json()) {
                document["passed"] = json!(false);
                document["diagnostics"] = document["error"]["diagnostics"].clone();
                print_json(&document)?;
            }
            return Err(error);
        }
    };
    if options.output.json {
        return print_json(&record(&examined));
    }
    if !examined.warnings.is_empty() {
        print_diagnostics(&examined.warnings);
    }
    note_redundancy(&examined.notes);
    print_text(&summary(&examined))
}

fn examine_specification(options: &Check) -> Result<CheckedModel> {
    let checked = read(&options.model.spec)?;
    let orders = orders(&checked.model, options.model.order.text())?;
    let redundancy = examine(&checked.model, &orders).map_err(Error::Specification)?;
    Ok(CheckedModel {
        notes: redundancy.describe(&checked.model),
        model: checked.model,
        orders,
        warnings: checked.warnings,
    })
}

fn record(examined: &CheckedModel) -> Value {
    json!({
        "schema": SCHEMA,
        "passed": true,
        "model": examined.model.name,
        "orders": examined.orders,
        "state": examined.model.state_names(&examined.orders),
        "diagnostics": examined.warnings.records(),
        "notes": examined.notes,
    })
}

fn summary(examined: &CheckedModel) -> String {
    let model = &examined.model;
    let fields = match examined.orders.as_slice() {
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
