//! `eomgen tour`: all steps on the paper's arm, with an HTML page.

use serde_json::json;

use crate::arguments::Tour;
use crate::count::count;
use crate::document::SCHEMA;
use crate::error::{Error, Result, print_bytes, print_text};
use crate::tour::{self, TourResult};

pub fn run(options: &Tour) -> Result {
    let result = tour::run(&options.out)?;
    let summary = summary(options.output.json, &result);
    match options.output.json {
        true => print_bytes(summary.as_bytes())?,
        false => print_text(&summary)?,
    }
    if result.certificate.passed {
        Ok(())
    } else {
        Err(Error::Failed)
    }
}

fn summary(json: bool, result: &TourResult) -> String {
    let (checks, switches) = (result.certificate.checks.len(), result.switches);
    let (page, passed) = (result.page.display(), result.certificate.passed);
    if json {
        let document = json!({
            "schema": SCHEMA,
            "page": page.to_string(),
            "passed": passed,
            "checks": checks,
            "switches": switches,
        });
        return format!("{document:#}\n");
    }
    let verdict = if passed { "passed" } else { "FAILED" };
    format!(
        "{} {verdict}, {} simulated\n{page}: open it in a browser\n",
        count(checks, "check"),
        count(switches, "switch")
    )
}
