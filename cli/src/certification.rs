//! Certificates as JSON and as summaries.

use eomgen_validate::certificate::{Certificate, Check, SkipKind, Verdict};

use crate::error::{Error, Result};

pub fn document(certificate: &Certificate) -> Result<String> {
    let text = serde_json::to_string_pretty(certificate)
        .map_err(|error| Error::input(error.to_string()))?;
    Ok(text + "\n")
}

/// Returns one line per check, coverage and verdict.
pub fn summary(certificate: &Certificate) -> String {
    let mut text = format!("{}, order {}\n", certificate.model, certificate.order);
    let width = certificate
        .checks
        .iter()
        .map(|check| check.name.len())
        .max()
        .unwrap_or(0);
    for check in &certificate.checks {
        text.push_str(&format!("  {:width$}  {}\n", check.name, verdict(check)));
    }
    if let Some(coverage) = &certificate.coverage {
        text.push_str(&format!("coverage: {}\n", coverage.sentence()));
    }
    text.push_str(match certificate.verdict {
        Verdict::Passed => "passed\n",
        Verdict::Partial => "PARTIAL: no check failed, but some were not run\n",
        Verdict::Failed => "FAILED\n",
    });
    text
}

fn verdict(check: &Check) -> String {
    let detail = if check.detail.is_empty() {
        String::new()
    } else {
        format!("  ({})", check.detail)
    };
    match check.skipped.as_ref().map(|skip| skip.kind) {
        Some(SkipKind::NotApplicable) => return format!("not applicable{detail}"),
        Some(SkipKind::NotRun) => return format!("NOT RUN{detail}"),
        None => {}
    }
    let value = check
        .value
        .map_or("not finite".to_owned(), |value| format!("{value:.1e}"));
    let word = if check.passed { "passed" } else { "FAILED" };
    format!("{word}   {value} of {:.0e}{detail}", check.tolerance)
}
