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

/// Result of a preliminary fit.
#[derive(Clone, Debug, PartialEq)]
pub enum PreliminaryOutcome {
    /// Remaining fraction of the squared residual.
    Remaining {
        /// The fraction. If it exceeds 1, the fit did not converge.
        fraction: f64,
        /// True if the residual is that of whole windows, false for their initial segments.
        is_whole: bool,
    },
    /// The fit failed for this reason.
    Failed(String),
}

impl PreliminaryOutcome {
    /// Returns the remaining fraction of a fit that converged.
    pub fn remaining_fraction(&self) -> Option<f64> {
        match self {
            Self::Remaining { fraction, .. } if *fraction <= 1.0 => Some(*fraction),
            _ => None,
        }
    }
}

impl fmt::Display for PreliminaryOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Remaining { fraction, is_whole } => {
                let residual = match is_whole {
                    true => "squared residual",
                    false => "initial-segment residual",
                };
                match self.remaining_fraction() {
                    Some(_) => write!(f, "{:.1} % of the {residual} remains", 100.0 * fraction),
                    None => write!(
                        f,
                        "its fit did not converge: the {residual} did not decrease"
                    ),
                }
            }
            Self::Failed(reason) => write!(f, "not fitted: {reason}"),
        }
    }
}

/// Preliminary fits that succeeded, the best first, and the results of all fits.
pub struct PreliminaryFits {
    /// Fits that succeeded.
    pub fits: Vec<(Hypothesis, PreliminaryFit)>,
    /// Results of all fits, by the responses of their candidates.
    pub outcomes: Vec<(Vec<ResponseId>, PreliminaryOutcome)>,
}

/// Fits hypotheses to the initial segments of windows in parallel. The best fit is first.
pub fn run_preliminary_fits(
    pool: &CandidatePool<'_>,
    hypotheses: Vec<Hypothesis>,
) -> Vec<(Hypothesis, PreliminaryFit)> {
    run_reported_fits(pool, hypotheses).fits
}

/// Runs preliminary fits like [`run_preliminary_fits`], and returns the results of all fits.
pub fn run_reported_fits(pool: &CandidatePool<'_>, hypotheses: Vec<Hypothesis>) -> PreliminaryFits {
    let without_candidates = pool.screening.predict(&[]).cost;
    // Each result is reported when its fit ends, because some fits take long.
    let fitted = |hypothesis: Hypothesis| {
        let preliminary = hypothesis::fit_preliminary(pool, &hypothesis);
        let outcome = match &preliminary {
            Ok(fit) => PreliminaryOutcome::Remaining {
                fraction: fit.cost / without_candidates,
                is_whole: pool.uses_whole_windows,
            },
            Err(error) => PreliminaryOutcome::Failed(shorten_failure(error)),
        };
        let label = hypothesis::describe_hypothesis(pool, &hypothesis);
        (pool.context.progress)(&format!("  {label}: {outcome}"));
        let responses = hypothesis.responses.clone();
        (
            preliminary.ok().map(|fit| (hypothesis, fit)),
            (responses, outcome),
        )
    };
    let (fits, outcomes): (Vec<Option<(Hypothesis, PreliminaryFit)>>, Vec<_>) =
        hypotheses.into_par_iter().map(fitted).unzip();
    let mut fits: Vec<(Hypothesis, PreliminaryFit)> = fits.into_iter().flatten().collect();
    fits.sort_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
    PreliminaryFits { fits, outcomes }
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
            Ok(fitted) => fitted.describe(pool.context.floor),
            Err(error) => format!("not fitted: {}", shorten_failure(error)),
        };
        let label = hypothesis::describe_hypothesis(pool, &hypothesis);
        (pool.context.progress)(&format!("  {label}: {outcome}"));
        tested.ok()
    };
    preliminaries.into_par_iter().filter_map(fitted).collect()
}

/// Returns the first line of an error, without the location in the candidate's specification.
fn shorten_failure(error: &DiscoverError) -> String {
    let message = error.to_string();
    let line = message.lines().next().unwrap_or_default();
    line.trim_start_matches("error: ").to_owned()
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

impl FittedHypothesis {
    /// Returns the number of unknowns of the candidates, and the fit.
    pub fn size_and_fit(&self) -> (usize, &Fit) {
        (self.effect_unknowns.len(), &self.fit)
    }

    /// Describes the residuals and the result of the acceptance test. `floor`: noise floor, in
    /// standard deviations of the noise.
    pub fn describe(&self, floor: f64) -> String {
        let (train, test) = (self.fit.train.rms / floor, self.fit.test.rms / floor);
        match &self.verdict {
            Err(rejection @ Rejection::Interrupted) => {
                format!("a training residual of {train:.2} noise floors; {rejection}")
            }
            Err(rejection) => format!("{}; {rejection}", describe_residuals(train, test)),
            Ok(_) => format!("{}; accepted", describe_residuals(train, test)),
        }
    }
}

/// Describes the residuals of a fit, in noise floors.
pub(crate) fn describe_residuals(train: f64, test: f64) -> String {
    format!("residuals of {train:.2} (training) and {test:.2} (test) noise floors")
}

#[cfg(test)]
mod tests {
    use super::PreliminaryOutcome;

    #[test]
    fn failed_fits_have_no_percentage() {
        let outcome = |fraction: f64| PreliminaryOutcome::Remaining {
            fraction,
            is_whole: false,
        };
        assert_eq!(
            outcome(0.178).to_string(),
            "17.8 % of the initial-segment residual remains"
        );
        for fraction in [1.2, 397189.317, f64::INFINITY, f64::NAN] {
            assert!(!outcome(fraction).to_string().contains('%'));
            assert_eq!(outcome(fraction).remaining_fraction(), None);
        }
    }
}
