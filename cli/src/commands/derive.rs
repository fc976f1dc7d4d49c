//! `eomgen derive`: the equations of motion on stdout.

use codegen::report::Report;

use crate::arguments::{Derive, Format};
use crate::problem::{Outcome, Problem, say};
use crate::variant::Variant;

/// Runs the command.
pub fn run(options: &Derive) -> Outcome {
    let variant = Variant::load_to_read(&options.spec, options.order.as_deref())?;
    let format = if options.json {
        Format::Json
    } else {
        options.format
    };
    let evaluator = variant.evaluator();
    let report = Report::new(&variant.model, &variant.equations, &evaluator);
    match format {
        Format::Text => say(&report.text()),
        Format::Latex => say(&report.latex()),
        Format::Json => {
            let text = serde_json::to_string_pretty(&report)
                .map_err(|error| Problem::input(error.to_string()))?;
            say(&format!("{text}\n"))
        }
    }
}
