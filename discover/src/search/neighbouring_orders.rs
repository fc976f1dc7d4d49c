//! Neighbouring orders of a named wave over an angle. The spectrum of a residual resolves orders to
//! one divided by the number of turns in the record. In addition, its lines are shifted along the
//! motion of a model without the wave. Neighbouring orders are therefore fitted until the best
//! order has worse neighbours.

use crate::catalogue::candidate::{Candidate, list_candidates};
use crate::catalogue::sites::find_sites;
use crate::catalogue::usual_motion::UsualMotion;
use crate::ids::{CandidateId, ResponseId};
use crate::search::alternatives::start_from_answer;
use crate::search::context::RoundContext;
use crate::search::hypothesis_fits::{FittedHypothesis, run_full_fits};
use crate::search::motion_of_fit::compute_usual_motion;
use crate::search::pool::CandidatePool;
use crate::search::screening::{Screening, screen_candidates};
use crate::search::selection::select_best_fit;
use crate::search::tested_pool::TestedPool;
use crate::thresholds;

/// If the best hypothesis is a wave over an angle, fits the neighbouring orders of it and of all
/// orders with nearly as small a residual. If the best order reaches the residual of a correct
/// model, these orders must reach it too. Orders from numbers of teeth are known and have no neighbours.
pub fn follow_orders(context: RoundContext<'_>, mut tested: TestedPool) -> TestedPool {
    let mut tried: Vec<u32> = Vec::new();
    while tried.len() < thresholds::MAX_FOLLOWED_ORDERS {
        let Some((best, orders)) = find_missing_orders(context, &tested, &tried) else {
            break;
        };
        tried.extend(&orders);
        let label = best.label();
        let known = list_fitted_candidates(&tested);
        let new = list_orders(context, &best, &orders);
        if new.is_empty() {
            break;
        }
        let candidates = [known, new].concat();
        let screening = screen_candidates(context.problem, context.fit, &candidates, 1.0);
        let Some(responses) = renumber(&tested, &candidates, &screening) else {
            break;
        };
        (tested.candidates, tested.screening) = (candidates, screening);
        for (fitted, responses) in tested.fitted_hypotheses.iter_mut().zip(responses) {
            fitted.responses = responses;
        }
        fit_orders(context, &mut tested, &label, &orders);
    }
    tested
}

/// If the best hypothesis is a wave over an angle, returns it and the neighbours of the orders with
/// nearly as small a residual. Orders that are already fitted or tried are left out.
fn find_missing_orders(
    context: RoundContext<'_>,
    tested: &TestedPool,
    tried: &[u32],
) -> Option<(Candidate, Vec<u32>)> {
    let best = &tested.fitted_hypotheses[select_best_fit(&tested.fitted_hypotheses)?.index()];
    let single = |fitted: &FittedHypothesis| match fitted.responses[..] {
        [response] => Some(tested.candidate(response)),
        _ => None,
    };
    let wave = single(best)?;
    if wave.on_mesh || wave.angle_order.is_none() {
        return None;
    }
    let same = tested.fitted_hypotheses.iter().filter_map(|fitted| {
        let own = single(fitted).filter(|own| own.is_same_effect_as(wave))?;
        Some((own.angle_order.as_ref()?.1, fitted))
    });
    let same: Vec<(u32, &FittedHypothesis)> = same.collect();
    let most = thresholds::MAX_RIVAL_COST_RATIO.sqrt() * best.fit.rms();
    let is_near = |fitted: &FittedHypothesis| match best.fit.is_at_floor(context.floor) {
        true => fitted.fit.is_at_floor(context.floor),
        false => fitted.fit.rms() < most,
    };
    let near = same.iter().filter(|(_, fitted)| is_near(fitted));
    let mut neighbours: Vec<u32> = near.flat_map(|(order, _)| [order - 1, order + 1]).collect();
    neighbours.sort_unstable();
    neighbours.dedup();
    neighbours.retain(|order| {
        let is_fitted = same.iter().any(|(known, _)| known == order);
        (1..=thresholds::MAX_SHAFT_ORDER).contains(order) && !is_fitted && !tried.contains(order)
    });
    (!neighbours.is_empty()).then(|| (wave.clone(), neighbours))
}

/// Returns the candidates of all fitted hypotheses.
fn list_fitted_candidates(tested: &TestedPool) -> Vec<Candidate> {
    let is_fitted = |id: &CandidateId| {
        let mut fitted = tested.fitted_hypotheses.iter();
        fitted.any(|fitted| {
            let mut own = fitted.responses.iter();
            own.any(|response| tested.screening.responses[*response].candidate == *id)
        })
    };
    let ids = CandidateId::first(tested.candidates.len()).filter(is_fitted);
    ids.map(|id| tested.candidates[id].clone()).collect()
}

/// Returns a wave with these orders. Orders without a full period in the motion are left out.
fn list_orders(context: RoundContext<'_>, wave: &Candidate, orders: &[u32]) -> Vec<Candidate> {
    let model = context.fit.model.specification();
    let sites = find_sites(model);
    let seen = sites
        .iter()
        .filter_map(|site| site.arguments.get("on"))
        .map(|on| (on.clone(), orders.to_vec()));
    let motion = UsualMotion {
        orders: seen.collect(),
        ..compute_usual_motion(context.problem, context.fit, &sites)
    };
    let effects = context
        .effects
        .iter()
        .filter(|effect| effect.name == wave.effect);
    let mut found = list_candidates(model, effects, &sites, &motion);
    found.retain(|candidate| {
        let order = candidate.angle_order.as_ref().map(|(_, order)| order);
        candidate.is_same_effect_as(wave) && order.is_some_and(|order| orders.contains(order))
    });
    found
}

/// Returns the responses of each fitted hypothesis in another screening of their candidates; `None`
/// if a candidate has no response there.
fn renumber(
    tested: &TestedPool,
    candidates: &[Candidate],
    screening: &Screening,
) -> Option<Vec<Vec<ResponseId>>> {
    let label = |id: ResponseId| candidates[screening.responses[id].candidate.index()].label();
    let renumbered = |response: &ResponseId| {
        let known = tested.candidate(*response).label();
        ResponseId::first(screening.responses.len()).find(|id| label(*id) == known)
    };
    let of = |fitted: &FittedHypothesis| fitted.responses.iter().map(renumbered).collect();
    tested.fitted_hypotheses.iter().map(of).collect()
}

/// Fits a wave with these orders, starting from the estimates of the best fit.
fn fit_orders(context: RoundContext<'_>, tested: &mut TestedPool, label: &str, orders: &[u32]) {
    let pool = CandidatePool::new(context, &tested.candidates, &tested.screening, true);
    let responses = ResponseId::first(pool.screening.responses.len());
    let best = tested.fitted_hypotheses.iter().find_map(|fitted| {
        let [response] = fitted.responses[..] else {
            return None;
        };
        (pool.candidate(response).label() == label).then_some((fitted, response))
    });
    let Some((fitted, response)) = best else {
        return;
    };
    let is_wanted = |id: &ResponseId| {
        let own = pool.candidate(*id);
        let order = own.angle_order.as_ref().map(|(_, order)| order);
        own.is_same_effect_as(pool.candidate(response))
            && order.is_some_and(|order| orders.contains(order))
    };
    let wanted: Vec<ResponseId> = responses.filter(is_wanted).collect();
    let mut found = Vec::new();
    for pair in wanted.chunks(thresholds::PARALLEL_FIT_COUNT) {
        let started = start_from_answer(&pool, fitted, response, pair, f64::INFINITY);
        found.extend(run_full_fits(&pool, started.unwrap_or_default()));
    }
    found.retain(|fitted| fitted.explains_records);
    tested.fitted_hypotheses.extend(found);
}
