//! The certificate of a variant: which checks it went through and how it fared. Only the
//! record; the checks are in `checks`.

use serde::Serialize;

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
    /// Whether no check failed; skipped checks do not count.
    pub passed: bool,
    /// The checks in the order they were made.
    pub checks: Vec<Check>,
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
    /// Whether it could not be made.
    pub skipped: bool,
    /// How many states were used, where the worst was found, why it was skipped.
    pub detail: String,
}

impl Certificate {
    /// The certificate with `checks`; an empty one does not pass.
    pub fn new(model: &str, order: usize, checks: Vec<Check>) -> Self {
        Self {
            schema: SCHEMA,
            model: model.to_owned(),
            order,
            passed: checks.iter().any(|check| check.passed)
                && checks.iter().all(|check| check.passed || check.skipped),
            checks,
        }
    }

    /// The checks that were made and did not pass.
    pub fn failures(&self) -> impl Iterator<Item = &Check> {
        self.checks
            .iter()
            .filter(|check| !check.passed && !check.skipped)
    }
}

impl Check {
    /// A check that found `worst` as its largest deviation.
    pub fn made(name: impl Into<String>, worst: Worst, tolerance: f64) -> Self {
        Self {
            name: name.into(),
            value: worst.value.is_finite().then_some(worst.value),
            tolerance,
            passed: worst.value <= tolerance,
            skipped: false,
            detail: worst.detail,
        }
    }

    /// A check that could not be made.
    pub fn skipped(name: impl Into<String>, tolerance: f64, reason: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            value: None,
            tolerance,
            passed: false,
            skipped: true,
            detail: reason.into(),
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

    #[test]
    fn a_certificate_has_the_agreed_fields() {
        let checks = vec![
            Check::made("made", Worst::of(1e-15, "200 states"), 1e-12),
            Check::skipped("skipped", 0.0, "no compiler"),
        ];
        let json = serde_json::to_value(Certificate::new("arm", 4, checks)).unwrap_or_default();
        assert_eq!(json["schema"], 1);
        assert_eq!((&json["model"], &json["order"]), (&"arm".into(), &4.into()));
        assert_eq!(json["passed"], true);
        assert_eq!(json["checks"][0]["value"], 1e-15);
        assert_eq!(json["checks"][0]["tolerance"], 1e-12);
        assert_eq!(json["checks"][1]["skipped"], true);
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
            assert!(!Certificate::new("m", 0, checks).passed);
        }
        assert!(!Certificate::new("m", 0, Vec::new()).passed);
        let skipped = vec![Check::skipped("s", 0.0, "")];
        assert!(!Certificate::new("m", 0, skipped).passed);
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
