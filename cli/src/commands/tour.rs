//! `eomgen tour`: the newcomer's walk through everything.

use serde_json::json;

use crate::arguments::Tour;
use crate::error::{Error, Result, say, say_bytes};
use crate::output::SCHEMA;
use crate::tour::{TourResult, walk};

/// Runs the command.
pub fn run(options: &Tour) -> Result {
    let walked = walk(&options.out)?;
    let summary = summary(options.output.json, &walked);
    match options.output.json {
        true => say_bytes(summary.as_bytes())?,
        false => say(&summary)?,
    }
    if walked.certificate.passed {
        Ok(())
    } else {
        Err(Error::Failed)
    }
}

/// What is said at the end.
fn summary(json: bool, walked: &TourResult) -> String {
    let (checks, switches) = (walked.certificate.checks.len(), walked.switches);
    let (page, passed) = (walked.page.display(), walked.certificate.passed);
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
    format!("{checks} checks {verdict}, {switches} switches simulated\nopen {page}\n")
}
