//! Certificates as JSON and as summaries.

use eomgen_validate::certificate::{Certificate, Check, SkipKind, Verdict};
use eomgen_validate::rounding::Bounds;

use crate::error::{Error, Result};
use crate::instruction_table::table;

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
    if let Some(bounds) = &certificate.bounds {
        text.push_str(&bounds_table(bounds));
    }
    for bounds in &certificate.instructions {
        text.push_str(&table(bounds));
    }
    text.push_str(match certificate.verdict {
        Verdict::Passed => "passed\n",
        Verdict::Partial => "PARTIAL: no check failed, but some were not run\n",
        Verdict::Failed => "FAILED\n",
    });
    text
}

/// Returns one line per quantity with the bounds of its rounding errors.
fn bounds_table(bounds: &Bounds) -> String {
    let mut text = "rounding errors, at most\n".to_owned();
    let names = bounds.quantities.iter().map(|quantity| quantity.name.len());
    let width = names.max().unwrap_or(0);
    for both in bounds.quantities.chunks(2) {
        let words = both.iter().map(|quantity| match quantity.bound {
            Some(bound) => format!("{bound:.1e} {}", quantity.precision),
            None => format!("not bounded {}", quantity.precision),
        });
        let words: Vec<String> = words.collect();
        let reason = both.iter().find_map(|quantity| quantity.reason.as_deref());
        let note = match (reason, &both[0].unit) {
            (Some(reason), _) => format!("  ({reason})"),
            (None, Some(unit)) => format!("  [{unit}]"),
            (None, None) => String::new(),
        };
        text.push_str(&format!(
            "  {:width$}  {}{note}\n",
            both[0].name,
            words.join(", ")
        ));
    }
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
