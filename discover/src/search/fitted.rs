//! Hypotheses fitted, side by side: to the beginnings of windows, and in full.

use crate::ids::ResponseId;
use rayon::prelude::*;

use crate::error::DiscoverError;
use crate::fit::fitted::Fit;
use crate::fit::full;
use crate::fit::preliminary::PreliminaryFit;
use crate::search::acceptance::{EffectUnknown, TestStatistics, acceptance_test, explains};
use crate::search::hypothesis::{self, Hypothesis, own_unknowns};
use crate::search::pool::Pool;
use crate::search::rejection::Rejection;
use crate::search::split_sample::SplitSample;

/// A hypothesis fitted in full.
pub struct FittedHypothesis {
    /// The responses of its candidates.
    pub responses: Vec<ResponseId>,
    /// Their unknowns.
    pub own: Vec<EffectUnknown>,
    /// The fit with them.
    pub fit: Fit,
    /// Whether they are accepted.
    pub verdict: Result<TestStatistics, Rejection>,
    /// Whether they explain the records, though their sizes may be uncertain: another name of what
    /// is accepted.
    pub explains: bool,
    /// The probability that noise alone lets the test records speak for them as much.
    pub p_value: Option<f64>,
}

/// Preliminary fits of hypotheses, side by side; the best first.
pub fn preliminary_fits(
    pool: &Pool<'_>,
    hypotheses: Vec<Hypothesis>,
) -> Vec<(Hypothesis, PreliminaryFit)> {
    let alone = pool.screening.predicted(&[]).cost;
    let preliminaries: Vec<Result<PreliminaryFit, DiscoverError>> = hypotheses
        .par_iter()
        .map(|hypothesis| hypothesis::preliminary(pool, hypothesis))
        .collect();
    let mut found = Vec::new();
    for (hypothesis, preliminary) in hypotheses.into_iter().zip(preliminaries) {
        let label = hypothesis::label(pool, &hypothesis);
        match preliminary {
            Ok(preliminary) => {
                let part = 100.0 * preliminary.cost / alone;
                let of = if pool.is_whole {
                    "squares"
                } else {
                    "beginnings of windows"
                };
                (pool.context.progress)(&format!("  {label}: {part:.1} % left of the {of}"));
                found.push((hypothesis, preliminary));
            }
            Err(error) => (pool.context.progress)(&format!("  {label}: {error}")),
        }
    }
    found.sort_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
    found
}

/// Preliminary fits fitted in full, side by side.
pub fn full_fits(
    pool: &Pool<'_>,
    preliminaries: Vec<(Hypothesis, PreliminaryFit)>,
) -> Vec<FittedHypothesis> {
    let fits: Vec<(Hypothesis, Result<Fit, DiscoverError>)> = preliminaries
        .into_par_iter()
        .map(|(hypothesis, preliminary)| {
            (
                hypothesis,
                full::complete(pool.context.problem, preliminary),
            )
        })
        .collect();
    let mut fitted_hypotheses = Vec::new();
    let held_out = match fits.is_empty() {
        true => None,
        false => SplitSample::of(pool.context.problem, pool.context.fit),
    };
    for (hypothesis, new) in fits {
        let label = hypothesis::label(pool, &hypothesis);
        match new {
            Ok(new) => {
                let own = own_unknowns(pool, &hypothesis);
                let p_value = held_out.as_ref().and_then(|of| of.p_value(&new, &own));
                pool.context.problem.judged.count();
                let verdict = acceptance_test(pool.context.fit, &new, &own);
                let verdict = verdict.map(|statistics| TestStatistics {
                    p_value,
                    ..statistics
                });
                let explains = explains(pool.context.fit, &new, &own).is_ok();
                let outcome = verdict
                    .as_ref()
                    .err()
                    .map_or_else(|| "accepted".to_owned(), Rejection::to_string);
                let (train, test) = (new.train.rms, new.test.rms);
                (pool.context.progress)(&format!(
                    "  {label}: residuals of {train:.2} standard deviations of the noise in training, {test:.2} in test; {outcome}"
                ));
                fitted_hypotheses.push(FittedHypothesis {
                    responses: hypothesis.responses,
                    own,
                    fit: new,
                    verdict,
                    explains,
                    p_value,
                });
            }
            Err(error) => (pool.context.progress)(&format!("  {label}: {error}")),
        }
    }
    fitted_hypotheses
}
