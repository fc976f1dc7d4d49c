//! The certificate of a variant: what was checked, which checks it went through and how it
//! fared. Only the record; the checks are in `checks`.

use serde::{Serialize, Serializer};

pub use crate::coverage::Coverage;

/// The version of the certificate's form.
pub const SCHEMA: u32 = 1;

/// The result of all checks of one model at one order.
#[derive(Clone, Debug, Serialize)]
pub struct Certificate {
    /// Version of this form.
    pub schema: u32,
    /// The model's name.
    pub model: String,
    /// The order.
    pub order: usize,
    /// What derived and emitted it, with its version.
    pub generator: String,
    /// SHA-256 of the specification's text, 64 lower-case hexadecimal digits.
    pub specification_sha256: String,
    /// SHA-256 of the emitted source; none (null) if nothing was emitted.
    pub source_sha256: Option<String>,
    /// What was asked for beside the rates, by the names of `--with`.
    pub with: Vec<String>,
    /// The values of all parameters, in SI, in the order of the specification.
    #[serde(serialize_with = "by_name")]
    pub parameters: Vec<(String, f64)>,
    /// The result of all checks.
    pub verdict: Verdict,
    /// Whether the verdict is [`Verdict::Passed`].
    pub passed: bool,
    /// Regimes in which states were tried; none (null) if no check was made.
    pub coverage: Option<Coverage>,
    /// The checks in the order they were made.
    pub checks: Vec<Check>,
}

/// The result of all checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Every check that applies was run and passed.
    Passed,
    /// No check failed, but one that applies was not run, or not for all regimes.
    Partial,
    /// A check failed, or none was run.
    Failed,
}

impl Verdict {
    fn of(checks: &[Check]) -> Self {
        let is_not_run = |check: &Check| {
            let skipped = check.skipped.as_ref();
            skipped.is_some_and(|skip| skip.kind == SkipKind::NotRun)
        };
        let has_failed = |check: &Check| !check.passed && check.skipped.is_none();
        if checks.iter().any(has_failed) || !checks.iter().any(|check| check.passed) {
            Self::Failed
        } else if checks.iter().any(is_not_run) {
            Self::Partial
        } else {
            Self::Passed
        }
    }

    /// The word in JSON.
    pub fn word(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Partial => "partial",
            Self::Failed => "failed",
        }
    }
}

/// Why a check was skipped.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Skip {
    /// Whether there was anything to check.
    pub kind: SkipKind,
    /// The reason.
    pub reason: String,
}

/// Whether a skipped check applies to the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SkipKind {
    /// The model has nothing that this check compares.
    NotApplicable,
    /// The check applies and could not be run.
    NotRun,
}

/// One check.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// What was checked.
    pub name: String,
    /// The worst deviation found; none (null) if the check was skipped, or if a deviation
    /// is no finite number.
    pub value: Option<f64>,
    /// The largest deviation that passes.
    pub tolerance: f64,
    /// Whether it was made and the deviation is within the tolerance.
    pub passed: bool,
    /// Why it was skipped; none (`false` in JSON) if it was made.
    #[serde(serialize_with = "or_false")]
    pub skipped: Option<Skip>,
    /// How many states were used, where the worst was found, why it was skipped.
    pub detail: String,
}

/// What a certificate is about.
#[derive(Clone, Debug, Default)]
pub struct Certified {
    /// The model's name.
    pub model: String,
    /// The order.
    pub order: usize,
    /// SHA-256 of the specification's text.
    pub specification_sha256: String,
    /// SHA-256 of the emitted source, if there is one.
    pub source_sha256: Option<String>,
    /// What was asked for, by name.
    pub with: Vec<String>,
    /// Names and values of all parameters, in SI.
    pub parameters: Vec<(String, f64)>,
}

impl Certificate {
    /// The certificate of `about` with `checks`; an empty one does not pass.
    pub fn new(about: Certified, coverage: Option<Coverage>, checks: Vec<Check>) -> Self {
        let verdict = Verdict::of(&checks);
        Self {
            schema: SCHEMA,
            model: about.model,
            order: about.order,
            generator: concat!("eomgen ", env!("CARGO_PKG_VERSION")).to_owned(),
            specification_sha256: about.specification_sha256,
            source_sha256: about.source_sha256,
            with: about.with,
            parameters: about.parameters,
            verdict,
            passed: verdict == Verdict::Passed,
            coverage,
            checks,
        }
    }

    /// The checks that were made and did not pass.
    pub fn failures(&self) -> impl Iterator<Item = &Check> {
        self.checks
            .iter()
            .filter(|check| !check.passed && check.skipped.is_none())
    }
}

/// What there is, or `false`.
fn or_false<S: Serializer>(skip: &Option<Skip>, serializer: S) -> Result<S::Ok, S::Error> {
    match skip {
        Some(skip) => skip.serialize(serializer),
        None => serializer.serialize_bool(false),
    }
}

/// Pairs as one JSON object, in their order.
fn by_name<S: Serializer>(pairs: &[(String, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().map(|(name, value)| (name, value)))
}

impl Check {
    /// A check that found `worst` as its largest deviation.
    pub fn made(name: impl Into<String>, worst: Worst, tolerance: f64) -> Self {
        Self {
            name: name.into(),
            value: worst.value.is_finite().then_some(worst.value),
            tolerance,
            passed: worst.value <= tolerance,
            skipped: None,
            detail: worst.detail,
        }
    }

    /// A check that has nothing to compare in this model.
    pub fn not_applicable(
        name: impl Into<String>,
        tolerance: f64,
        reason: impl Into<String>,
    ) -> Self {
        Self::skipped(
            name.into(),
            tolerance,
            SkipKind::NotApplicable,
            reason.into(),
        )
    }

    /// A check that applies to this model and could not be run.
    pub fn not_run(name: impl Into<String>, tolerance: f64, reason: impl Into<String>) -> Self {
        Self::skipped(name.into(), tolerance, SkipKind::NotRun, reason.into())
    }

    /// A check that was not made.
    pub fn skipped(name: String, tolerance: f64, kind: SkipKind, reason: String) -> Self {
        Self {
            name,
            value: None,
            tolerance,
            passed: false,
            detail: reason.clone(),
            skipped: Some(Skip { kind, reason }),
        }
    }
}

/// The largest deviation so far, and where it was found. What is not a number counts as
/// infinite, and nothing examined at all as infinite too.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    value: f64,
    detail: String,
}

impl Default for Worst {
    fn default() -> Self {
        Self {
            value: f64::INFINITY,
            detail: "nothing was examined".to_owned(),
        }
    }
}

impl Worst {
    /// A deviation with what there is to say about it.
    pub fn of(value: f64, detail: impl Into<String>) -> Self {
        Self {
            value: if value.is_nan() { f64::INFINITY } else { value },
            detail: detail.into(),
        }
    }

    /// Keeps the larger of two deviations.
    pub fn include(&mut self, other: Self) {
        let untouched = *self == Self::default();
        if untouched || other.value > self.value {
            *self = other;
        }
    }

    /// Says of how many the largest was kept.
    pub fn among(self, count: usize, what: &str) -> Self {
        Self {
            detail: format!("{count} {what}, worst: {}", self.detail),
            ..self
        }
    }

    /// The largest deviation.
    pub fn value(&self) -> f64 {
        self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arm() -> Certified {
        Certified {
            model: "arm".into(),
            order: 4,
            specification_sha256: "0123".into(),
            source_sha256: Some("4567".into()),
            with: vec!["jacobians".into()],
            parameters: vec![("l".into(), 0.5)],
        }
    }

    #[test]
    fn a_certificate_has_the_agreed_fields() {
        let checks = vec![
            Check::made("made", Worst::of(1e-15, "200 states"), 1e-12),
            Check::not_applicable("skipped", 0.0, "no field"),
        ];
        let json = serde_json::to_value(Certificate::new(arm(), None, checks)).unwrap_or_default();
        assert_eq!(json["schema"], 1);
        assert_eq!((&json["model"], &json["order"]), (&"arm".into(), &4.into()));
        assert_eq!(
            json["generator"],
            format!("eomgen {}", env!("CARGO_PKG_VERSION"))
        );
        assert_eq!(json["specification_sha256"], "0123");
        assert_eq!(json["source_sha256"], "4567");
        assert_eq!(json["with"][0], "jacobians");
        assert_eq!(json["parameters"]["l"], 0.5);
        assert_eq!(json["passed"], true);
        assert_eq!(json["checks"][0]["value"], 1e-15);
        assert_eq!(json["checks"][0]["tolerance"], 1e-12);
        assert_eq!(json["verdict"], "passed");
        assert_eq!(json["checks"][0]["skipped"], false);
        let skipped = &json["checks"][1]["skipped"];
        assert_eq!(
            (&skipped["kind"], &skipped["reason"]),
            (&"not_applicable".into(), &"no field".into())
        );
    }

    #[test]
    fn one_failure_one_nan_or_nothing_at_all_fails() {
        let good = Check::made("good", Worst::of(0.0, ""), 0.0);
        for bad in [
            Worst::of(1.0, ""),
            Worst::of(f64::NAN, ""),
            Worst::default(),
        ] {
            let checks = vec![good.clone(), Check::made("bad", bad, 1e-12)];
            assert!(!Certificate::new(arm(), None, checks).passed);
        }
        assert!(!Certificate::new(arm(), None, Vec::new()).passed);
        let skipped = vec![Check::not_applicable("s", 0.0, "")];
        assert!(!Certificate::new(arm(), None, skipped).passed);
    }

    #[test]
    fn checks_not_run_make_it_partial_and_those_not_applicable_do_not() {
        let good = Check::made("good", Worst::of(0.0, ""), 0.0);
        let absent = Check::not_applicable("a", 0.0, "no field");
        let missed = Check::not_run("b", 0.0, "no compiler");
        let bad = Check::made("bad", Worst::of(1.0, ""), 0.0);
        for (others, verdict) in [
            (vec![absent.clone()], Verdict::Passed),
            (vec![absent, missed.clone()], Verdict::Partial),
            (vec![missed, bad], Verdict::Failed),
        ] {
            let checks = [vec![good.clone()], others].concat();
            let certificate = Certificate::new(arm(), None, checks);
            assert_eq!(certificate.verdict, verdict);
            assert_eq!(certificate.passed, verdict == Verdict::Passed);
        }
    }

    #[test]
    fn the_worst_is_kept_with_its_place() {
        let mut worst = Worst::default();
        worst.include(Worst::of(0.5, "here"));
        worst.include(Worst::of(0.25, "there"));
        assert_eq!(worst, Worst::of(0.5, "here"));
        worst.include(Worst::of(f64::NAN, "lost"));
        assert_eq!(worst.value(), f64::INFINITY);
    }
}
