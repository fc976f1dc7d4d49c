//! Certificate of a variant: results of its checks.

use serde::{Serialize, Serializer};

pub use crate::coverage::Coverage;
use crate::instructions::InstructionBounds;
use crate::rounding::Bounds;

/// Version of the certificate format.
pub const SCHEMA: u32 = 2;

/// Results of all checks of one model at one order.
#[derive(Clone, Debug, Serialize)]
pub struct Certificate {
    /// Version of the format, [`SCHEMA`].
    pub schema: u32,
    /// Name of the model.
    pub model: String,
    /// Order of the variant.
    pub order: usize,
    /// Name and version of the generator.
    pub generator: String,
    /// SHA-256 of the specification's text, 64 lower-case hexadecimal digits.
    pub specification_sha256: String,
    /// SHA-256 of the emitted source; `None` if no source was emitted.
    pub source_sha256: Option<String>,
    /// Hashes of the emitted C, one entry for each prefix.
    pub c_sources: Vec<CSourceHashes>,
    /// Hash of the emitted functions for CasADi; `None` if there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub casadi: Option<CasadiHash>,
    /// Hash of the functional mock-up unit; `None` if there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<UnitHash>,
    /// Hashes in the identity symbols of the emitted sources, as `eomgen identify` prints them.
    pub identities: Vec<String>,
    /// Requested outputs, by their names in `--with`.
    pub with: Vec<String>,
    /// Values of all parameters, in SI, in the order of the specification.
    #[serde(serialize_with = "by_name")]
    pub parameters: Vec<(String, f64)>,
    /// Parameters that were set, in their declared units.
    #[serde(serialize_with = "by_name")]
    pub settings: Vec<(String, f64)>,
    /// Result of all checks together.
    pub verdict: Verdict,
    /// True if the verdict is [`Verdict::Passed`].
    pub passed: bool,
    /// Regimes covered by the sampled states; `None` if no check was run.
    pub coverage: Option<Coverage>,
    /// Checks in the order in which they were run.
    pub checks: Vec<Check>,
    /// Bounds of rounding errors, if they were requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<Bounds>,
    /// Bounds of the instructions and the stack of the emitted C, if they were requested.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub instructions: Vec<InstructionBounds>,
    /// Text of the specification, complete with the files that it extends.
    pub specification: String,
}

/// Hashes of the two files of emitted C.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CSourceHashes {
    /// Prefix of the C names: the files are `NAME.c` and `NAME.h`.
    pub name: String,
    /// SHA-256 of `NAME.c`.
    pub source_sha256: String,
    /// SHA-256 of `NAME.h`.
    pub header_sha256: String,
}

/// Hash of emitted functions for CasADi.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CasadiHash {
    /// Prefix of the names: the file is `NAME_casadi.c`.
    pub name: String,
    /// SHA-256 of the file.
    pub source_sha256: String,
    /// Requested outputs, by their names in `--with`.
    pub with: Vec<String>,
}

/// Hash of a functional mock-up unit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct UnitHash {
    /// Name of the unit: the file is `NAME.fmu`.
    pub name: String,
    /// SHA-256 of the file.
    pub sha256: String,
}

/// Result of all checks together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// All applicable checks were run and passed.
    Passed,
    /// No check failed, but an applicable check was not run or did not cover all regimes.
    Partial,
    /// A check failed, or no check was run.
    Failed,
}

impl Verdict {
    fn from_checks(checks: &[Check]) -> Self {
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

    /// Returns the verdict's name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Partial => "partial",
            Self::Failed => "failed",
        }
    }
}

/// Reason for skipping a check.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Skip {
    /// Kind of reason: not applicable or not run.
    pub kind: SkipKind,
    /// Text of the reason.
    pub reason: String,
}

/// Kind of reason for skipping a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SkipKind {
    /// The model has nothing to compare.
    NotApplicable,
    /// The check applies but could not be run.
    NotRun,
}

/// Result of one check.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// Name of the check.
    pub name: String,
    /// Largest deviation; `None` if the check was skipped or a deviation is not finite.
    pub value: Option<f64>,
    /// Largest deviation that passes.
    pub tolerance: f64,
    /// True if the check was run and the deviation is within the tolerance.
    pub passed: bool,
    /// Reason for skipping the check; `None` (`false` in JSON) if it was run.
    #[serde(serialize_with = "or_false")]
    pub skipped: Option<Skip>,
    /// Number of compared states and location of the largest deviation, or the reason for skipping.
    pub detail: String,
}

/// Subject of a certificate.
#[derive(Clone, Debug, Default)]
pub struct CertificateHeader {
    /// Name of the model.
    pub model: String,
    /// Order of the variant.
    pub order: usize,
    /// SHA-256 of the specification's text.
    pub specification_sha256: String,
    /// SHA-256 of the emitted source, if any.
    pub source_sha256: Option<String>,
    /// Hashes of the emitted C, one entry for each prefix.
    pub c_sources: Vec<CSourceHashes>,
    /// Hash of the emitted functions for CasADi; `None` if there are none.
    pub casadi: Option<CasadiHash>,
    /// Hash of the functional mock-up unit; `None` if there is none.
    pub unit: Option<UnitHash>,
    /// Hashes in the identity symbols of the emitted sources.
    pub identities: Vec<String>,
    /// Parameters that were set, in their declared units.
    pub settings: Vec<(String, f64)>,
    /// Text of the specification.
    pub specification: String,
    /// Names of the requested outputs.
    pub with: Vec<String>,
    /// Names and values of all parameters, in SI.
    pub parameters: Vec<(String, f64)>,
}

impl Certificate {
    /// Returns the names of the checks that were run.
    pub fn run_checks(&self) -> Vec<String> {
        self.names(|check| check.skipped.is_none())
    }

    /// Returns the names of the checks that failed.
    pub fn failed_checks(&self) -> Vec<String> {
        self.names(|check| !check.passed && check.skipped.is_none())
    }

    fn names(&self, is_listed: impl Fn(&Check) -> bool) -> Vec<String> {
        let listed = self.checks.iter().filter(|check| is_listed(check));
        listed.map(|check| check.name.clone()).collect()
    }

    /// Creates the certificate with the header `about`. A certificate without checks does not pass.
    pub fn new(about: CertificateHeader, coverage: Option<Coverage>, checks: Vec<Check>) -> Self {
        let verdict = Verdict::from_checks(&checks);
        Self {
            schema: SCHEMA,
            model: about.model,
            order: about.order,
            generator: concat!("eomgen ", env!("CARGO_PKG_VERSION")).to_owned(),
            specification_sha256: about.specification_sha256,
            source_sha256: about.source_sha256,
            c_sources: about.c_sources,
            casadi: about.casadi,
            unit: about.unit,
            identities: about.identities,
            settings: about.settings,
            specification: about.specification,
            with: about.with,
            parameters: about.parameters,
            verdict,
            passed: verdict == Verdict::Passed,
            coverage,
            checks,
            bounds: None,
            instructions: Vec::new(),
        }
    }

    /// Returns the checks that were run and failed.
    pub fn failures(&self) -> impl Iterator<Item = &Check> {
        self.checks
            .iter()
            .filter(|check| !check.passed && check.skipped.is_none())
    }
}

fn or_false<S: Serializer>(skip: &Option<Skip>, serializer: S) -> Result<S::Ok, S::Error> {
    match skip {
        Some(skip) => skip.serialize(serializer),
        None => serializer.serialize_bool(false),
    }
}

fn by_name<S: Serializer>(pairs: &[(String, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().map(|(name, value)| (name, value)))
}

impl Check {
    /// Creates a check that was run, with `worst` as its largest deviation.
    pub fn from_deviation(name: impl Into<String>, worst: Worst, tolerance: f64) -> Self {
        Self {
            name: name.into(),
            value: worst.value.is_finite().then_some(worst.value),
            tolerance,
            passed: worst.value <= tolerance,
            skipped: None,
            detail: worst.detail,
        }
    }

    /// Creates a skipped check that has nothing to compare in this model.
    pub fn not_applicable(
        name: impl Into<String>,
        tolerance: f64,
        reason: impl Into<String>,
    ) -> Self {
        Self::with_skip(
            name.into(),
            tolerance,
            SkipKind::NotApplicable,
            reason.into(),
        )
    }

    /// Creates a skipped check that applies but could not be run.
    pub fn not_run(name: impl Into<String>, tolerance: f64, reason: impl Into<String>) -> Self {
        Self::with_skip(name.into(), tolerance, SkipKind::NotRun, reason.into())
    }

    /// Creates a skipped check.
    pub fn with_skip(name: String, tolerance: f64, kind: SkipKind, reason: String) -> Self {
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

/// Largest deviation so far and its location. NaN counts as infinity, and so does a check without any deviation.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    value: f64,
    detail: String,
}

impl Default for Worst {
    fn default() -> Self {
        Self {
            value: f64::INFINITY,
            detail: "no state was compared".to_owned(),
        }
    }
}

impl Worst {
    /// Creates a deviation with a description of its location. NaN becomes infinity.
    pub fn from_deviation(value: f64, detail: impl Into<String>) -> Self {
        Self {
            value: if value.is_nan() { f64::INFINITY } else { value },
            detail: detail.into(),
        }
    }

    /// Combines two comparisons. If only `other` deviates, its detail replaces the first one.
    pub fn with(self, other: Option<Self>) -> Self {
        let Some(other) = other else { return self };
        let detail = match (self.value > 0.0, other.value > 0.0) {
            (true, _) => self.detail,
            (false, true) => other.detail,
            (false, false) if other.detail.is_empty() => self.detail,
            (false, false) => format!("{}, {}", self.detail, other.detail),
        };
        Self::from_deviation(self.value + other.value, detail)
    }

    /// Keeps the larger of two values, with its detail.
    pub fn include(&mut self, other: Self) {
        let untouched = *self == Self::default();
        if untouched || other.value > self.value {
            *self = other;
        }
    }

    /// Prefixes the description with the number of compared items; `what` is the plural noun for the items.
    pub fn with_count(self, count: usize, what: &str) -> Self {
        Self {
            detail: format!("{count} {what}, worst: {}", self.detail),
            ..self
        }
    }

    /// Returns the largest deviation.
    pub fn value(&self) -> f64 {
        self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arm() -> CertificateHeader {
        CertificateHeader {
            model: "arm".into(),
            order: 4,
            specification_sha256: "0123".into(),
            source_sha256: Some("4567".into()),
            with: vec!["jacobians".into()],
            parameters: vec![("l".into(), 0.5)],
            ..CertificateHeader::default()
        }
    }

    #[test]
    fn certificate_has_documented_json_fields() {
        let checks = vec![
            Check::from_deviation("made", Worst::from_deviation(1e-15, "200 states"), 1e-12),
            Check::not_applicable("skipped", 0.0, "no field"),
        ];
        let json = serde_json::to_value(Certificate::new(arm(), None, checks)).unwrap_or_default();
        assert_eq!(json["schema"], 2);
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
    fn failed_nan_or_missing_check_fails_certificate() {
        let good = Check::from_deviation("good", Worst::from_deviation(0.0, ""), 0.0);
        for bad in [
            Worst::from_deviation(1.0, ""),
            Worst::from_deviation(f64::NAN, ""),
            Worst::default(),
        ] {
            let checks = vec![good.clone(), Check::from_deviation("bad", bad, 1e-12)];
            assert!(!Certificate::new(arm(), None, checks).passed);
        }
        assert!(!Certificate::new(arm(), None, Vec::new()).passed);
        let skipped = vec![Check::not_applicable("s", 0.0, "")];
        assert!(!Certificate::new(arm(), None, skipped).passed);
    }

    #[test]
    fn only_checks_not_run_make_certificate_partial() {
        let good = Check::from_deviation("good", Worst::from_deviation(0.0, ""), 0.0);
        let absent = Check::not_applicable("a", 0.0, "no field");
        let missed = Check::not_run("b", 0.0, "no compiler");
        let bad = Check::from_deviation("bad", Worst::from_deviation(1.0, ""), 0.0);
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
    fn largest_deviation_is_kept_with_its_location() {
        let mut worst = Worst::default();
        worst.include(Worst::from_deviation(0.5, "here"));
        worst.include(Worst::from_deviation(0.25, "there"));
        assert_eq!(worst, Worst::from_deviation(0.5, "here"));
        worst.include(Worst::from_deviation(f64::NAN, "lost"));
        assert_eq!(worst.value(), f64::INFINITY);
    }
}
