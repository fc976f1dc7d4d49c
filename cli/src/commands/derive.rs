//! `eomgen derive`: the equations of motion on stdout.

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_codegen::report::Report;

use crate::arguments::{Derive, Format};
use crate::error::{Error, Result, say, say_bytes};
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
        Format::Text => say(&report.text()),
        Format::Latex => say_bytes(report.latex().as_bytes()),
        Format::Json => {
            let text = serde_json::to_string_pretty(&report)
                .map_err(|error| Error::input(error.to_string()))?;
            say_bytes(format!("{text}\n").as_bytes())
        }
    }
}
