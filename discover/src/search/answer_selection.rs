//! Result of a round: the named hypothesis.

use crate::search::alternatives::test_alternatives;
use crate::search::neighbouring_orders::follow_orders;
use crate::search::pool::CandidatePool;
use crate::search::round::SearchRound;
use crate::search::selection::{SelectedHypothesis, select_best_fit, select_hypothesis};
use crate::search::tested_pool::TestedPool;

/// Selects the named hypothesis among all tested hypotheses; `None` if none is accepted.
pub fn select_answer(
    round: &SearchRound<'_>,
    mut tested: Vec<TestedPool>,
) -> Option<SelectedHypothesis> {
    let least = |tested: &TestedPool| {
        let accepted = tested
            .fitted_hypotheses
            .iter()
            .filter(|fitted| fitted.verdict.is_ok());
        let rms = accepted.map(|fitted| fitted.fit.rms());
        rms.fold(f64::INFINITY, f64::min)
    };
    let best = (0..tested.len())
        .filter(|number| least(&tested[*number]).is_finite())
        .min_by(|a, b| least(&tested[*a]).total_cmp(&least(&tested[*b])));
    let TestedPool {
        candidates,
        screening,
        mut fitted_hypotheses,
        ..
    } = tested.swap_remove(best?);
    fitted_hypotheses.retain(|fitted| fitted.explains_records);
    if let Some(answer) = select_best_fit(&fitted_hypotheses) {
        let pool = CandidatePool::new(round.context, &candidates, &screening, true);
        test_alternatives(&pool, &mut fitted_hypotheses, answer);
    }
    fitted_hypotheses.retain(|fitted| fitted.explains_records);
    let tested = TestedPool {
        candidates,
        screening,
        fitted_hypotheses,
        preliminary_outcomes: Vec::new(),
    };
    select_hypothesis(round.context, follow_orders(round.context, tested))
}
