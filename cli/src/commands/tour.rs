//! `eomgen tour`: all steps on the paper's arm, with an HTML page.

use eomgen_validate::certificate::{Certificate, Verdict};
use serde_json::json;

use crate::arguments::Tour;
use crate::certification::{CheckCounts, applicable_checks};
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
    let counts = CheckCounts::new(&result.certificate);
    let page = result.page.display();
    if json {
        let document = json!({
            "schema": SCHEMA,
            "page": page.to_string(),
            "passed": result.certificate.passed,
            "verdict": result.certificate.verdict.name(),
            "checks": counts.passed + counts.failed + counts.not_run,
            "switches": result.switches,
        });
        return format!("{document:#}\n");
    }
    format!(
        "{}, {} simulated\n{}{page}: open it in a browser\n",
        describe_verdict(&result.certificate, counts),
        count(result.switches, "switch"),
        reasons_not_run(&result.certificate)
    )
}

/// Describes the verdict with the numbers of checks.
fn describe_verdict(certificate: &Certificate, counts: CheckCounts) -> String {
    let CheckCounts {
        passed,
        failed,
        not_run,
    } = counts;
    let passed = count(passed, "check");
    match certificate.verdict {
        Verdict::Passed => format!("{passed} passed"),
        Verdict::Partial => format!("PARTIAL: {passed} passed, {not_run} not run"),
        Verdict::Failed => format!("FAILED: {passed} passed, {failed} failed, {not_run} not run"),
    }
}

/// Returns one line for each reason for which checks were not run.
fn reasons_not_run(certificate: &Certificate) -> String {
    let checks = applicable_checks(certificate);
    let skipped = checks.iter().filter(|check| check.skipped.is_some());
    let mut reasons: Vec<&str> = skipped.map(|check| check.detail.as_str()).collect();
    reasons.dedup();
    let lines = reasons.iter();
    lines
        .map(|reason| format!("  NOT RUN  {reason}\n"))
        .collect()
}
