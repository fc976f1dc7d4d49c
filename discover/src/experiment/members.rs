//! Members of a class, each fitted to the records in place of the named effect.

use crate::catalogue::candidate::Candidate;
use crate::fit::fitted::Fit;
use crate::ids::{EffectId, ResponseId};
use crate::search::backward_elimination::without;
use crate::search::context::Context;
use crate::search::fitted::{full_fits, preliminary_fits};
use crate::search::found::Found;
use crate::search::hypothesis::Hypothesis;
use crate::search::pool::Pool;
use crate::search::screening::screening;
use crate::thresholds;

/// Fits each candidate that is indistinguishable from an accepted effect in its place, together
/// with the other accepted effects. The fit is `None` if it fails. `context`: context of the
/// search.
pub fn equivalent_fits(
    context: Context<'_>,
    found: &Found,
    effect: EffectId,
) -> Vec<(Candidate, Option<Fit>)> {
    let equivalent = &found.accepted[effect].equivalent;
    let others = match found.accepted.len() {
        1 => None,
        _ => without(context.problem, found, effect).ok(),
    };
    let fit = match (&others, found.accepted.len()) {
        (Some(others), _) => others,
        (None, 1) => &found.null,
        (None, _) => return equivalent.iter().map(|of| (of.clone(), None)).collect(),
    };
    let context = Context { fit, ..context };
    let is_whole = context.is_whole();
    let part = match is_whole {
        true => 1.0,
        false => thresholds::FIRST_PART,
    };
    let screening = screening(context.problem, fit, equivalent, part);
    let pool = Pool::new(context, equivalent, &screening, is_whole);
    let responses = ResponseId::first(screening.responses.len());
    let hypotheses = responses.map(|response| Hypothesis {
        sizes: screening.responses[response].values.clone(),
        responses: vec![response],
        deleted: None,
    });
    let mut fits: Vec<(String, Fit)> = Vec::new();
    for fitted in full_fits(&pool, preliminary_fits(&pool, hypotheses.collect())) {
        fits.push((pool.label(&fitted.responses), fitted.fit));
    }
    let of = |candidate: &Candidate| {
        let label = candidate.label();
        let place = fits.iter().position(|(known, _)| *known == label)?;
        Some(fits.swap_remove(place).1)
    };
    let mut of = of;
    equivalent
        .iter()
        .map(|candidate| (candidate.clone(), of(candidate)))
        .collect()
}
