//! Others in the place of a round's answer: an effect on one shaft of a gear looks like the same
//! effect on the next, and which of them is fitted better may be chance of where it began. What may
//! be meant instead is fitted once more from where the answer ended.

use crate::catalogue::candidate::{Candidate, candidates};
use crate::catalogue::effect::Effect;
use crate::catalogue::sites::sites;
use crate::fit::preliminary::PreliminaryFit;
use crate::model::usual_rates::usual_rates;
use crate::search::fitted::{FittedHypothesis, full_fits};
use crate::search::hypothesis::{Hypothesis, begun_at};
use crate::search::pool::Pool;
use crate::search::screening::screening;
use crate::thresholds;

/// Fits what may stand in the place of a fitted hypothesis from where that ended, and takes over
/// what leaves less than it did before.
pub fn test_alternatives(
    pool: &Pool<'_>,
    trials: &mut Vec<FittedHypothesis>,
    answer: usize,
    effects: &[Effect],
) {
    let preliminaries = alternatives(pool, trials, answer, effects).unwrap_or_default();
    for new in full_fits(pool, preliminaries) {
        let known = trials
            .iter_mut()
            .find(|trial| trial.responses == new.responses);
        match known {
            Some(known) if new.fit.rms() < known.fit.rms() => *known = new,
            Some(_) => {}
            None => trials.push(new),
        }
    }
}

/// The best of those that may stand in the place of a fitted hypothesis, begun where that ended;
/// none if it is not one effect with terms of its own.
fn alternatives(
    pool: &Pool<'_>,
    trials: &[FittedHypothesis],
    answer: usize,
    effects: &[Effect],
) -> Option<Vec<(Hypothesis, PreliminaryFit)>> {
    let trial = &trials[answer];
    let [response] = trial.responses[..] else {
        return None;
    };
    if pool.screening.responses[response].released.is_some() {
        return None;
    }
    let rivals = rivals(pool, trials, answer, response);
    let (rivals, there) = there(pool, trial, &rivals, effects);
    if there.is_empty() {
        return None;
    }
    (pool.context.progress)(&format!(
        "screening {} in the place of {}",
        there.len(),
        pool.candidate(response).label()
    ));
    let mut promised = promised(pool, trial, &there)?;
    promised.sort_by(|a, b| a.1.total_cmp(&b.1));
    promised.truncate(thresholds::FITS_AT_ONCE);
    let shaped = shaped(pool, trial).unwrap_or(1.0);
    let preliminaries = promised.into_iter().filter_map(|(place, left, sizes)| {
        let set = Hypothesis {
            responses: vec![rivals[place]],
            deleted: None,
            sizes,
        };
        let preliminary = begun_at(pool, &set, (&trial.fit, left), shaped).ok()?;
        Some((set, preliminary))
    });
    Some(preliminaries.collect())
}

/// Those of the rivals that there are in a fitted hypothesis' model, as candidates for that: names
/// that the fitted hypothesis took are not free there, and shapes go with the fitted hypothesis'.
fn there(
    pool: &Pool<'_>,
    trial: &FittedHypothesis,
    rivals: &[usize],
    effects: &[Effect],
) -> (Vec<usize>, Vec<Candidate>) {
    if rivals.is_empty() {
        return Default::default();
    }
    let model = trial.fit.plant.model();
    let known = candidates(
        model,
        effects,
        &sites(model),
        &usual_rates(pool.context.problem.dataset, model),
    );
    let shaped = shaped(pool, trial).unwrap_or(1.0);
    let again = |rival: &usize| {
        let label = pool.candidate(*rival).label();
        let found = known.iter().find(|candidate| candidate.label() == label)?;
        let mut found = found.clone();
        let shapes = found.parameters.iter_mut().map(|p| &mut p.shape);
        shapes.flatten().for_each(|shape| *shape *= shaped);
        Some((*rival, found))
    };
    rivals.iter().filter_map(again).unzip()
}

/// Which candidates promise to leave little without a fitted hypothesis' own terms, what they leave
/// and their sizes.
fn promised(
    pool: &Pool<'_>,
    trial: &FittedHypothesis,
    there: &[Candidate],
) -> Option<Vec<(usize, f64, Vec<f64>)>> {
    let mut screening = screening(pool.context.problem, &trial.fit, there, 1.0);
    let left = screening.left(&[]).0;
    let theta = &trial.fit.train.estimate.theta;
    for own in &trial.own {
        screening = match own.is_shape {
            true => screening.held(own.place),
            false => screening.without(own.place, theta[own.place])?,
        };
    }
    let promised = (0..screening.responses.len()).map(|place| {
        let (left, sizes) = screening.left(&[place]);
        (screening.responses[place].candidate, left, sizes)
    });
    Some(
        promised
            .filter(|(_, promised, _)| *promised < thresholds::RIVAL * left)
            .collect(),
    )
}

/// How a fitted hypothesis' shape ended, in what it began with: a speed that friction falls with is
/// so many times the usual one wherever the friction sits.
fn shaped(pool: &Pool<'_>, trial: &FittedHypothesis) -> Option<f64> {
    let shape = trial.own.iter().find(|own| own.is_shape)?;
    let began = pool.screening.responses[trial.responses[0]]
        .trials
        .iter()
        .find(|trial| trial.is_shape)?;
    Some(trial.fit.train.estimate.theta[shape.place] / began.unknown.start)
}

/// The same effect elsewhere, and what the record hardly tells from it, unless it leaves as
/// little already.
fn rivals(
    pool: &Pool<'_>,
    trials: &[FittedHypothesis],
    answer: usize,
    response: usize,
) -> Vec<usize> {
    let selected = pool.candidate(response);
    let enough = (1.0 + thresholds::DISTINGUISHED) * trials[answer].fit.rms();
    let is_rival = |place: &usize| {
        let of = pool.candidate(*place);
        let done = trials
            .iter()
            .any(|trial| trial.responses == [*place] && trial.fit.rms() < enough);
        let turns = |c: &Candidate| c.order.as_ref().map(|(_, order)| *order);
        let same = of.effect == selected.effect && turns(of) == turns(selected);
        let is_own = pool.screening.responses[*place].released.is_none();
        let alike = || pool.screening.similarity(*place, response) > thresholds::INDISTINGUISHABLE;
        *place != response && is_own && !done && (same || alike())
    };
    (0..pool.screening.responses.len())
        .filter(is_rival)
        .collect()
}
