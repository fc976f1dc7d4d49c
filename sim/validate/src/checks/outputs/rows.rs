//! Deviations of rows and the checks that report them.

use super::check_context::CheckContext;
use crate::certificate::{Check, SkipKind, Worst};
use crate::outputs::requested_jacobians;

/// Tolerance of finite differences, relative to the largest term of the row, for a change of the variable by its size.
/// The rows are accurate to 1e-14 of their largest term. Division by the step size increases this error by a factor of
/// 16 for the longest step and 65536 for the shortest.
pub const DIFFERENCE_TOLERANCE: f64 = 1e-9;
/// Step sizes of the finite differences: long for smooth rows, short for rows with large higher derivatives.
pub(super) const STEPS: [f64; 5] = [
    1.0 / 16.0,
    1.0 / 128.0,
    1.0 / 1024.0,
    1.0 / 8192.0,
    1.0 / 65536.0,
];

/// Returns |difference|/scale; 0 for equal values, infinity for NaN.
pub(super) fn relative_deviation(difference: f64, scale: f64) -> f64 {
    let ratio = (difference / scale).abs();
    if difference == 0.0 {
        0.0
    } else if ratio.is_nan() {
        f64::INFINITY
    } else {
        ratio
    }
}

pub(super) fn worst_deviation(deviations: impl IntoIterator<Item = f64>) -> f64 {
    deviations.into_iter().fold(0.0, f64::max)
}

#[derive(Default)]
pub(super) struct OutputFindings {
    worst_by_check: Vec<(&'static str, f64, Worst)>,
}

impl OutputFindings {
    pub fn include(&mut self, name: &'static str, tolerance: f64, deviation: f64, place: &str) {
        let worst = Worst::from_deviation(deviation, place);
        match self
            .worst_by_check
            .iter_mut()
            .find(|(known, ..)| *known == name)
        {
            Some((_, _, known)) => known.include(worst),
            None => self.worst_by_check.push((name, tolerance, worst)),
        }
    }

    pub fn into_checks(
        self,
        judged: &CheckContext<'_>,
        names: &[String],
        states: usize,
    ) -> Vec<Check> {
        let mut checks = Vec::new();
        for name in expected_checks(names) {
            let found = self
                .worst_by_check
                .iter()
                .find(|(known, ..)| *known == name);
            checks.push(match found {
                Some((_, tolerance, worst)) => Check::from_deviation(
                    name,
                    worst.clone().with_count(states, "states"),
                    *tolerance,
                ),
                None => {
                    let (kind, reason) = skip_reason(judged, name);
                    Check::with_skip(
                        name.to_owned(),
                        DIFFERENCE_TOLERANCE,
                        kind,
                        reason.to_owned(),
                    )
                }
            });
        }
        checks
    }
}

pub(super) fn expected_checks(names: &[String]) -> Vec<&'static str> {
    let has = |name: &str| names.iter().any(|known| known == name);
    let mut found = Vec::new();
    for name in ["bias_forces", "inverse_dynamics", "guard_rates"] {
        if has(name) {
            found.push(name);
        }
    }
    found.extend(requested_jacobians(names));
    if has("products") {
        found.extend([
            "jacobian_vector_product",
            "vector_jacobian_product",
            "vector_jacobian_product_by_parameters",
        ]);
    }
    found
}

pub(super) fn skip_reason(judged: &CheckContext<'_>, name: &str) -> (SkipKind, &'static str) {
    if name.ends_with("_by_inputs") && judged.oracle.input_count() == 0 {
        (SkipKind::NotApplicable, "the model has no input")
    } else if name == "guard_rates" && judged.oracle.switches().is_empty() {
        let reason = "the model has no piecewise function";
        (SkipKind::NotApplicable, reason)
    } else {
        let reason = "every sampled state is too close to a switching surface or to the boundary of the model's domain";
        (SkipKind::NotRun, reason)
    }
}
