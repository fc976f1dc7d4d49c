//! Hypotheses that the training records support but the held-out records do not.

use crate::fit::fit_result::Fit;
use crate::ids::UnknownId;
use crate::search::hypothesis_fits::FittedHypothesis;
use crate::search::rejection::Rejection;
use crate::search::tested_pool::TestedPool;
use crate::thresholds;

/// Hypothesis that explains the training records but not the held-out records.
pub struct UnconfirmedHypothesis {
    /// Description of the hypothesis.
    pub label: String,
    /// Unknowns of the hypothesis in the fit.
    pub effect_unknowns: Vec<UnknownId>,
    /// Fit with the hypothesis.
    pub fit: Fit,
}

/// Returns the hypothesis with the lowest training residual of a round without an accepted effect,
/// if only the held-out records reject it. `before`: fit without the hypothesis.
pub fn find_unconfirmed(tested: &mut [TestedPool], before: &Fit) -> Option<UnconfirmedHypothesis> {
    let accepted = |pool: &TestedPool| {
        let mut fitted = pool.fitted_hypotheses.iter();
        fitted.any(|fitted| fitted.verdict.is_ok())
    };
    if tested.iter().any(accepted) {
        return None;
    }
    let found = tested.iter().enumerate().flat_map(|(pool, of)| {
        let fitted = of.fitted_hypotheses.iter().enumerate();
        let unconfirmed = fitted.filter(|(_, fitted)| is_unconfirmed(fitted, before));
        unconfirmed.map(move |(index, fitted)| (pool, index, fitted.fit.train.rms))
    });
    let (pool, index, _) = found.min_by(|a, b| a.2.total_cmp(&b.2))?;
    let pool = &mut tested[pool];
    let fitted = pool.fitted_hypotheses.swap_remove(index);
    let labels = fitted.responses.iter().map(|response| {
        let candidate = pool.screening.responses[*response].candidate;
        pool.candidates[candidate].label()
    });
    Some(UnconfirmedHypothesis {
        label: labels.collect::<Vec<String>>().join(" and "),
        effect_unknowns: fitted
            .effect_unknowns
            .iter()
            .map(|own| own.unknown)
            .collect(),
        fit: fitted.fit,
    })
}

/// Returns true if a hypothesis was rejected only because of the held-out records, and it halves
/// the residual of the training records.
fn is_unconfirmed(fitted: &FittedHypothesis, before: &Fit) -> bool {
    let by_held_out = matches!(
        fitted.verdict,
        Err(Rejection::HeldOut(_) | Rejection::StandardErrors(_))
    );
    by_held_out && fitted.fit.train.rms * thresholds::MIN_CONTRADICTION_RATIO < before.train.rms
}
