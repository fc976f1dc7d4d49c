//! `eomgen derive`: the equations of motion on stdout.

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_codegen::report::Report;

use crate::arguments::{Derive, Format};
use crate::error::{Error, Result, print_bytes, print_text};
use crate::model::load_to_read;

pub fn run(options: &Derive) -> Result {
    let compiled = load_to_read(&options.model.spec, options.model.order.text())?;
    let format = if options.output.json {
        Format::Json
    } else {
        options.format
    };
    let evaluator = Evaluator::new(compiled.program().clone());
    let report = Report::new(compiled.model(), compiled.equations(), &evaluator);
    match format {
        Format::Text => print_text(&report.text()),
        Format::Latex => print_bytes(report.latex().as_bytes()),
        Format::Json => {
            let text = serde_json::to_string_pretty(&report)
                .map_err(|error| Error::input(error.to_string()))?;
            print_bytes(format!("{text}\n").as_bytes())
        }
    }
}
