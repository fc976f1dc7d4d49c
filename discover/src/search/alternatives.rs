//! Alternatives to the result of a round. Effects on different shafts of a gear have similar
//! responses, and the order of their fits may depend on the initial values. Therefore similar
//! effects are fitted again, starting from the estimates of the selected fit.

use std::collections::BTreeMap;

use crate::catalogue::candidate::{Candidate, list_candidates};
use crate::catalogue::effect::SiteKind;
use crate::catalogue::site::Site;
use crate::catalogue::sites::find_sites;
use crate::catalogue::usual_motion::UsualMotion;
use crate::fit::preliminary_fit::{PreliminaryFit, WarmStart};
use crate::ids::{CandidateId, FittedId, ResponseId};
use crate::search::hypothesis::{Hypothesis, fit_from_warm_start};
use crate::search::hypothesis_fits::{FittedHypothesis, run_full_fits};
use crate::search::motion_of_fit::compute_usual_motion;
use crate::search::pool::CandidatePool;
use crate::search::screening::{LinearPrediction, screen_candidates};
use crate::thresholds;

/// Fits the alternatives to a hypothesis, starting from its estimates, and keeps results with lower
/// residuals.
pub fn test_alternatives(
    pool: &CandidatePool<'_>,
    fitted_hypotheses: &mut Vec<FittedHypothesis>,
    answer: FittedId,
) {
    let preliminaries = start_alternatives(pool, fitted_hypotheses, answer).unwrap_or_default();
    for new in run_full_fits(pool, preliminaries) {
        let known = fitted_hypotheses
            .iter_mut()
            .find(|fitted| fitted.responses == new.responses);
        match known {
            Some(known) if new.fit.rms() < known.fit.rms() => *known = new,
            Some(_) => {}
            None => fitted_hypotheses.push(new),
        }
    }
}

/// Finds the best alternatives to a fitted hypothesis, starting from its estimates. Empty if the
/// hypothesis is not one effect with separate terms.
fn start_alternatives(
    pool: &CandidatePool<'_>,
    fitted_hypotheses: &[FittedHypothesis],
    answer: FittedId,
) -> Option<Vec<(Hypothesis, PreliminaryFit)>> {
    let fitted = &fitted_hypotheses[answer];
    let [response] = fitted.responses[..] else {
        return None;
    };
    if pool.screening.responses[response].dropped_prior.is_some() {
        return None;
    }
    let rivals = list_rivals(pool, fitted_hypotheses, answer, response);
    // If the residual exceeds that of a correct model, the same effect is tested at all other
    // sites, because predictions along the motion of an incorrect model may be wrong.
    let at_floor = fitted.fit.is_at_floor(pool.context.floor);
    let most = match at_floor {
        true => thresholds::MAX_RIVAL_COST_RATIO,
        false => f64::INFINITY,
    };
    start_from_answer(pool, fitted, response, &rivals, most)
}

/// Runs preliminary fits of rivals of a fitted effect, `response`, starting from its estimates.
/// Rivals have the lowest predicted residuals, below `most` times the predicted residual of the
/// fitted effect.
pub(super) fn start_from_answer(
    pool: &CandidatePool<'_>,
    fitted: &FittedHypothesis,
    response: ResponseId,
    rivals: &[ResponseId],
    most: f64,
) -> Option<Vec<(Hypothesis, PreliminaryFit)>> {
    let (rivals, in_model) = find_in_model(pool, fitted, rivals);
    if in_model.is_empty() {
        return None;
    }
    (pool.context.progress)(&format!(
        "screening {} alternatives to {}",
        in_model.len(),
        pool.candidate(response).label()
    ));
    let mut predictions = predict_candidates(pool, fitted, &in_model, most)?;
    predictions.sort_by(|a, b| a.prediction.cost.total_cmp(&b.prediction.cost));
    predictions.truncate(thresholds::PARALLEL_FIT_COUNT);
    let shape_ratio = compute_shape_ratio(pool, fitted).unwrap_or(1.0);
    let preliminaries = predictions.into_iter().filter_map(|of| {
        let LinearPrediction { cost, sizes } = of.prediction;
        let hypothesis = Hypothesis {
            responses: vec![rivals[of.candidate]],
            replaced_parameter: None,
            predicted_sizes: sizes,
        };
        let warm_start = WarmStart {
            fit: &fitted.fit,
            cost,
            max_rms: thresholds::MAX_WARM_START_RATIO * fitted.fit.train.rms,
        };
        let preliminary = fit_from_warm_start(pool, &hypothesis, warm_start, shape_ratio).ok()?;
        Some((hypothesis, preliminary))
    });
    Some(preliminaries.collect())
}

/// Returns those rivals that exist in the model of a fitted hypothesis, as candidates of this
/// model. Their parameters have names that are not in use there, and their shapes are scaled like
/// the fitted shape.
fn find_in_model(
    pool: &CandidatePool<'_>,
    fitted: &FittedHypothesis,
    rivals: &[ResponseId],
) -> (Vec<ResponseId>, Vec<Candidate>) {
    if rivals.is_empty() {
        return Default::default();
    }
    let model = fitted.fit.model.specification();
    let sites = find_sites(model);
    let motion = UsualMotion {
        orders: list_orders(pool, rivals, &sites),
        ..compute_usual_motion(pool.context.problem, &fitted.fit, &sites)
    };
    let known = list_candidates(model, pool.context.effects, &sites, &motion);
    let shape_ratio = compute_shape_ratio(pool, fitted).unwrap_or(1.0);
    let again = |rival: &ResponseId| {
        let label = pool.candidate(*rival).label();
        let found = known.iter().find(|candidate| candidate.label() == label)?;
        let mut found = found.clone();
        let shapes = found.parameters.iter_mut().map(|p| &mut p.shape_size);
        shapes.flatten().for_each(|shape| *shape *= shape_ratio);
        Some((*rival, found))
    };
    rivals.iter().filter_map(again).unzip()
}

/// Returns the orders of the rivals, for each angle.
fn list_orders(
    pool: &CandidatePool<'_>,
    rivals: &[ResponseId],
    sites: &[Site],
) -> BTreeMap<String, Vec<u32>> {
    let orders = rivals
        .iter()
        .filter_map(|rival| Some(pool.candidate(*rival).angle_order.as_ref()?.1));
    let orders: Vec<u32> = orders.collect();
    let angles = sites.iter().filter(|site| site.kind == SiteKind::Angle);
    let on = angles.filter_map(|site| site.arguments.get("on"));
    on.map(|on| (on.clone(), orders.clone())).collect()
}

/// Predicted residual of a candidate.
struct CandidatePrediction {
    candidate: CandidateId,
    prediction: LinearPrediction,
}

/// Returns the candidates with a predicted residual below a multiple of the residual of a fitted
/// hypothesis. The fit is linearised without the terms of this hypothesis.
fn predict_candidates(
    pool: &CandidatePool<'_>,
    fitted: &FittedHypothesis,
    in_model: &[Candidate],
    most: f64,
) -> Option<Vec<CandidatePrediction>> {
    let mut screening = screen_candidates(pool.context.problem, &fitted.fit, in_model, 1.0);
    let cost = screening.predict(&[]).cost;
    let theta = &fitted.fit.train.estimate.theta;
    for own in &fitted.effect_unknowns {
        screening = match own.is_shape {
            true => screening.with_nuisance_fixed(own.unknown),
            false => screening.with_nuisance_fixed_at(own.unknown, theta[own.unknown])?,
        };
    }
    let ids = ResponseId::first(screening.responses.len());
    let predictions = ids.map(|id| CandidatePrediction {
        candidate: screening.responses[id].candidate,
        prediction: screening.predict(&[id]),
    });
    Some(
        predictions
            .filter(|of| of.prediction.cost < most * cost)
            .collect(),
    )
}

/// Returns the ratio of the fitted shape of a hypothesis to its initial value. For example, the
/// Stribeck speed scales with the usual speed at its site.
fn compute_shape_ratio(pool: &CandidatePool<'_>, fitted: &FittedHypothesis) -> Option<f64> {
    let shape = fitted.effect_unknowns.iter().find(|own| own.is_shape)?;
    let began = pool.screening.responses[fitted.responses[0]]
        .candidate_unknowns
        .iter()
        .find(|of| of.is_shape)?;
    Some(fitted.fit.train.estimate.theta[shape.unknown] / began.unknown.start)
}

/// Returns the same effect at other sites and similar candidates. Candidates whose fits already
/// have an equally small residual are left out.
fn list_rivals(
    pool: &CandidatePool<'_>,
    fitted_hypotheses: &[FittedHypothesis],
    answer: FittedId,
    response: ResponseId,
) -> Vec<ResponseId> {
    let selected = pool.candidate(response);
    let enough = (1.0 + thresholds::MAX_CLASS_DIFFERENCE) * fitted_hypotheses[answer].fit.rms();
    let is_rival = |id: &ResponseId| {
        let of = pool.candidate(*id);
        let done = fitted_hypotheses
            .iter()
            .any(|fitted| fitted.responses == [*id] && fitted.fit.rms() < enough);
        let turns = |c: &Candidate| c.angle_order.as_ref().map(|(_, order)| *order);
        let same = of.effect == selected.effect && turns(of) == turns(selected);
        let is_own = pool.screening.responses[*id].dropped_prior.is_none();
        let similar = || {
            pool.screening.compute_similarity(*id, response) > thresholds::MIN_SIMILARITY_OF_RIVALS
        };
        *id != response && is_own && !done && (same || similar())
    };
    ResponseId::first(pool.screening.responses.len())
        .filter(is_rival)
        .collect()
}
