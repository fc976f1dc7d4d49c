//! Summaries of certificates, and certificates as JSON.

use eomgen_model_spec::source::sha256;
use eomgen_validate::certificate::{Certificate, Check, SkipKind, Verdict};
use eomgen_validate::meaning::describe;
use eomgen_validate::rounding::Bounds;

use crate::error::{Error, Result};
use crate::instruction_table::table;

/// Key of the hash over all other keys of a certificate; the last key.
const CONTENT_HASH: &str = "content_sha256";

/// Returns the certificate as JSON with the hash of its content.
pub fn document(certificate: &Certificate) -> Result<String> {
    let text = serde_json::to_string_pretty(certificate)
        .map_err(|error| Error::input(error.to_string()))?;
    let hash = sha256(compact(&text));
    let open = text.strip_suffix("\n}").unwrap_or(&text);
    Ok(format!("{open},\n  \"{CONTENT_HASH}\": \"{hash}\"\n}}\n"))
}

/// Returns true if the text of a certificate ends with the hash of its content; `None` without a hash.
pub fn has_valid_hash(text: &str) -> Option<bool> {
    let text = compact(text);
    let (content, rest) = text.rsplit_once(&format!(",\"{CONTENT_HASH}\":\""))?;
    let hash = rest.strip_suffix("\"}")?;
    Some(sha256(format!("{content}}}")) == hash)
}

/// Removes white space, which programs that format JSON change.
fn compact(text: &str) -> String {
    text.split_ascii_whitespace().collect()
}

/// Returns one line for each kind of check, then coverage and verdict.
pub fn summary(certificate: &Certificate) -> String {
    let mut text = format!("{}, order {}\n", certificate.model, certificate.order);
    let (skipped, applicable): (Vec<&Check>, Vec<&Check>) =
        (certificate.checks.iter()).partition(|check| is_not_applicable(check));
    for group in group_checks(&applicable) {
        text.push_str(&format!("  {}\n", describe_result(group)));
    }
    text.push_str(&describe_skipped(&skipped));
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

/// Returns one line for each quantity with the bounds of its rounding errors.
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

/// Returns the checks that apply to the model.
pub fn applicable_checks(certificate: &Certificate) -> Vec<&Check> {
    let checks = certificate.checks.iter();
    checks.filter(|check| !is_not_applicable(check)).collect()
}

/// Groups passed checks of the same statement. Every other check is a separate group.
pub fn group_checks<'a, 'c>(checks: &'a [&'c Check]) -> impl Iterator<Item = &'a [&'c Check]> {
    checks
        .chunk_by(|one, next| one.passed && next.passed && are_of_same_kind(&one.name, &next.name))
}

/// Numbers of the check groups of a certificate, by their result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckCounts {
    pub passed: usize,
    pub failed: usize,
    /// Checks that apply but could not be run.
    pub not_run: usize,
}

impl CheckCounts {
    pub fn new(certificate: &Certificate) -> Self {
        let checks = applicable_checks(certificate);
        let count = |is_counted: fn(&Check) -> bool| {
            let groups = group_checks(&checks);
            groups.filter(|group| is_counted(group[0])).count()
        };
        Self {
            passed: count(|check| check.passed),
            failed: count(|check| !check.passed && check.skipped.is_none()),
            not_run: count(|check| check.skipped.is_some()),
        }
    }
}

/// Returns true if two checks test the same statement, for example in different regimes.
fn are_of_same_kind(one: &str, other: &str) -> bool {
    let kind = |name: &str| name.split(' ').next().map(str::to_owned);
    kind(one) == kind(other) && kind(one).as_deref() != Some("reference")
}

/// Returns the statement that a check confirms, as a sentence.
pub fn statement(name: &str) -> String {
    describe(name).unwrap_or_else(|| name.replace('_', " "))
}

fn is_not_applicable(check: &Check) -> bool {
    let skipped = check.skipped.as_ref();
    skipped.is_some_and(|skip| skip.kind == SkipKind::NotApplicable)
}

/// Describes the result of several passed checks of one kind, or of a single check.
fn describe_result(group: &[&Check]) -> String {
    let first = group[0];
    let sentence = statement(&first.name);
    if first.passed {
        return format!("passed   {sentence}{}", describe_size(group));
    }
    match &first.skipped {
        Some(_) => format!("NOT RUN  {sentence} ({}: {})", first.name, first.detail),
        None => format!(
            "FAILED   {sentence} ({}: {}; {})",
            first.name,
            describe_deviation(first.value, first.tolerance),
            first.detail
        ),
    }
}

/// Describes the number of items that passed checks compared, and the largest deviation.
fn describe_size(group: &[&Check]) -> String {
    let first = group[0];
    let mut parts = Vec::new();
    let count = first.detail.split(", ").next().unwrap_or_default();
    match group.len() {
        1 if count.starts_with(|letter: char| letter.is_ascii_digit()) => {
            parts.push(count.to_owned());
        }
        1 => {}
        regimes => parts.push(format!("{regimes} regimes")),
    }
    if first.tolerance > 0.0 {
        let worst = group
            .iter()
            .filter_map(|check| check.value)
            .reduce(f64::max);
        parts.push(describe_deviation(worst, first.tolerance));
    }
    match parts.is_empty() {
        true => String::new(),
        false => format!(" ({})", parts.join("; ")),
    }
}

fn describe_deviation(value: Option<f64>, tolerance: f64) -> String {
    let value = match value {
        Some(0.0) => "0".to_owned(),
        Some(value) => format!("{value:.1e}"),
        None => "not finite".to_owned(),
    };
    match tolerance > 0.0 {
        true => format!("deviation {value} of at most {tolerance:.0e}"),
        false => format!("deviation {value}, none is allowed"),
    }
}

/// Counts the checks that do not apply, with their reasons.
fn describe_skipped(skipped: &[&Check]) -> String {
    let mut reasons: Vec<&str> = Vec::new();
    for check in skipped {
        if !reasons.contains(&check.detail.as_str()) {
            reasons.push(&check.detail);
        }
    }
    match skipped.len() {
        0 => String::new(),
        1 => format!("  1 check does not apply: {}\n", reasons.join("; ")),
        count => format!("  {count} checks do not apply: {}\n", reasons.join("; ")),
    }
}
