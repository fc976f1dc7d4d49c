//! Parallel fits of hypotheses: preliminary fits to the initial segments of windows, and full fits.

use std::fmt;

use crate::error::DiscoverError;
use crate::ids::ResponseId;
use rayon::prelude::*;

use crate::fit::fit_result::Fit;
use crate::fit::full_fit;
use crate::fit::preliminary_fit::PreliminaryFit;
use crate::search::acceptance::{EffectUnknown, TestStatistics, test_acceptance, test_explanation};
use crate::search::hypothesis::{self, Hypothesis, list_effect_unknowns};
use crate::search::pool::CandidatePool;
use crate::search::rejection::Rejection;
use crate::search::split_sample::SplitSampleTest;

/// Hypothesis with its full fit.
pub struct FittedHypothesis {
    /// Responses of its candidates.
    pub responses: Vec<ResponseId>,
    /// Unknowns of its candidates.
    pub effect_unknowns: Vec<EffectUnknown>,
    /// Fit with the candidates.
    pub fit: Fit,
    /// Result of the acceptance test.
    pub verdict: Result<TestStatistics, Rejection>,
    /// True if the candidates explain the records, even if their sizes are uncertain. Such
    /// candidates may be equivalent to an accepted effect.
    pub explains_records: bool,
    /// P-value of the test records.
    pub p_value: Option<f64>,
}

/// Fits hypotheses to the initial segments of windows in parallel. The best fit is first.
pub fn run_preliminary_fits(
    pool: &CandidatePool<'_>,
    hypotheses: Vec<Hypothesis>,
) -> Vec<(Hypothesis, PreliminaryFit)> {
    let without_candidates = pool.screening.predict(&[]).cost;
    let of = match pool.uses_whole_windows {
        true => "squared residual",
        false => "initial-segment residual",
    };
    // Each result is reported when its fit ends, because some fits take long.
    let fitted = |hypothesis: Hypothesis| {
        let preliminary = hypothesis::fit_preliminary(pool, &hypothesis);
        let left = match &preliminary {
            Ok(fit) => describe_remaining(fit.cost / without_candidates, of),
            Err(error) => describe_failure(error),
        };
        let label = hypothesis::describe_hypothesis(pool, &hypothesis);
        (pool.context.progress)(&format!("  {label}: {left}"));
        Some((hypothesis, preliminary.ok()?))
    };
    let mut found: Vec<(Hypothesis, PreliminaryFit)> =
        hypotheses.into_par_iter().filter_map(fitted).collect();
    found.sort_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
    found
}

/// Continues preliminary fits as full fits in parallel.
pub fn run_full_fits(
    pool: &CandidatePool<'_>,
    preliminaries: Vec<(Hypothesis, PreliminaryFit)>,
) -> Vec<FittedHypothesis> {
    let held_out = match preliminaries.is_empty() {
        true => None,
        false => SplitSampleTest::from_fit(pool.context.problem, pool.context.fit),
    };
    let fitted = |(hypothesis, preliminary): (Hypothesis, PreliminaryFit)| {
        let new = full_fit::complete_fit(pool.context.problem, preliminary);
        let tested = new.map(|new| test_fit(pool, &hypothesis, new, held_out.as_ref()));
        let outcome = match &tested {
            Ok(fitted) => fitted.to_string(),
            Err(error) => describe_failure(error),
        };
        let label = hypothesis::describe_hypothesis(pool, &hypothesis);
        (pool.context.progress)(&format!("  {label}: {outcome}"));
        tested.ok()
    };
    preliminaries.into_par_iter().filter_map(fitted).collect()
}

/// Describes the remaining fraction of a residual. If it exceeds 1, the fit did not converge.
fn describe_remaining(fraction: f64, of: &str) -> String {
    match fraction <= 1.0 {
        true => format!("{:.1} % of the {of} remains", 100.0 * fraction),
        false => format!("its fit did not converge: the {of} did not decrease"),
    }
}

/// Describes a failed fit in one line, without the location in the candidate's specification.
fn describe_failure(error: &DiscoverError) -> String {
    let message = error.to_string();
    let line = message.lines().next().unwrap_or_default();
    format!("not fitted: {}", line.trim_start_matches("error: "))
}

/// Tests the full fit of a hypothesis.
fn test_fit(
    pool: &CandidatePool<'_>,
    hypothesis: &Hypothesis,
    fit: Fit,
    held_out: Option<&SplitSampleTest>,
) -> FittedHypothesis {
    let own = list_effect_unknowns(pool, hypothesis);
    let p_value = held_out.and_then(|of| of.compute_p_value(&fit, &own));
    pool.context.problem.tested_hypotheses.increment();
    let is_interrupted =
        !fit.test.failed_windows.is_empty() && pool.context.problem.stop.is_requested();
    let verdict = match is_interrupted {
        true => Err(Rejection::Interrupted),
        false => test_acceptance(pool.context.fit, &fit, &own),
    };
    let verdict = verdict.map(|statistics| TestStatistics {
        p_value,
        ..statistics
    });
    FittedHypothesis {
        responses: hypothesis.responses.clone(),
        explains_records: !is_interrupted && test_explanation(pool.context.fit, &fit, &own).is_ok(),
        effect_unknowns: own,
        fit,
        verdict,
        p_value,
    }
}

impl fmt::Display for FittedHypothesis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (train, test) = (self.fit.train.rms, self.fit.test.rms);
        if let Err(rejection @ Rejection::Interrupted) = &self.verdict {
            return write!(
                f,
                "a residual of {train:.2} standard deviations of the noise in training records; {rejection}"
            );
        }
        write!(
            f,
            "residuals of {train:.2} (training) and {test:.2} (test) standard deviations of the noise; "
        )?;
        match &self.verdict {
            Ok(_) => write!(f, "accepted"),
            Err(rejection) => write!(f, "{rejection}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::describe_remaining;

    #[test]
    fn failed_fits_have_no_percentage() {
        let of = "initial-segment residual";
        assert_eq!(
            describe_remaining(0.178, of),
            "17.8 % of the initial-segment residual remains"
        );
        for fraction in [1.2, 397189.317, f64::INFINITY, f64::NAN] {
            assert!(!describe_remaining(fraction, of).contains('%'));
        }
    }
}
