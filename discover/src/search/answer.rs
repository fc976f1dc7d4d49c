//! Result of a round: the named hypothesis.

use crate::search::alternatives::test_alternatives;
use crate::search::pool::Pool;
use crate::search::round::Round;
use crate::search::selected::{Selected, best_of, selected};
use crate::search::tested::TestedPool;

/// Returns the named hypothesis of all tested ones; `None` if none is accepted.
pub fn answer(round: &Round<'_>, mut tested: Vec<TestedPool>) -> Option<Selected> {
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
    } = tested.swap_remove(best?);
    fitted_hypotheses.retain(|fitted| fitted.explains);
    if let Some(answer) = best_of(&fitted_hypotheses) {
        let pool = Pool::new(round.context, &candidates, &screening, true);
        test_alternatives(&pool, &mut fitted_hypotheses, answer);
    }
    fitted_hypotheses.retain(|fitted| fitted.explains);
    selected(
        round.context,
        TestedPool {
            candidates,
            screening,
            fitted_hypotheses,
        },
    )
}
