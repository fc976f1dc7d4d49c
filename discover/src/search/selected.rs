//! What is named of a round: the believed trial that leaves least, and whatever the records do
//! not tell from it.

use std::cmp::Ordering;

use crate::catalogue::candidate::Candidate;
use crate::fit::full::Fit;
use crate::search::acceptance::{Own, evidence};
use crate::search::fitted::{Task, Trial};
use crate::search::parameter_offsets;
use crate::search::screening::Screen;
use crate::thresholds;

/// Candidates, what they promise, and those of them that were fitted in earnest.
pub type Searched = (Vec<Candidate>, Screen, Vec<Trial>);

/// The believed trial that is named.
pub struct Named {
    /// Its candidates, in the order of its responses.
    pub candidates: Vec<Candidate>,
    /// The trial.
    pub trial: Trial,
    /// What cannot be told from each of them.
    pub equivalent: Vec<Vec<Candidate>>,
    /// Of a pair the half that was believed alone, by its number, and the test gap that it left.
    pub half: Option<(usize, f64)>,
}

/// What is named of the trials of a round that explain the records; none if nothing is believed. A parameter that
/// nobody called uncertain is the less plausible answer: it is named only if it leaves clearly
/// less than what looks like it.
pub fn named(task: Task<'_>, searched: Searched) -> Option<Named> {
    let named = best(with_other_halves(task, searched))?;
    let [candidate] = &named.candidates[..] else {
        return Some(named);
    };
    let with = (candidate, &named.trial.fit);
    let Some(((candidates, screen, trials), own)) = parameter_offsets::beside(task, candidate)
    else {
        return Some(named);
    };
    let (better, others): (Vec<Trial>, Vec<Trial>) = trials
        .into_iter()
        .partition(|trial| trial.verdict.is_ok() && is_clearly_better(&trial.fit, with.1));
    if !better.is_empty() {
        return best((candidates, screen, better));
    }
    let of = |trial: &Trial| &candidates[screen.responses[trial.responses[0]].candidate];
    let untold = others.iter().filter(|trial| {
        is_untold(
            with.1,
            &trial.fit,
            screen.similarity(own, trial.responses[0]),
        )
    });
    let undeclared: Vec<Candidate> = untold.map(|trial| of(trial).clone()).collect();
    let equivalent = [&named.equivalent[0][..], &undeclared].concat();
    Some(Named {
        equivalent: vec![equivalent],
        ..named
    })
}

/// The trials of a round with, if a pair is best, further pairs with what looks like one of its
/// halves.
fn with_other_halves(task: Task<'_>, (candidates, screen, mut trials): Searched) -> Searched {
    let round = task.round(&candidates, &screen, task.is_whole());
    if let Some(best) = best_of(&trials) {
        let mut further = round.other_halves(&trials, best);
        further.retain(|trial| trial.explains);
        trials.extend(further);
    }
    (candidates, screen, trials)
}

/// The believed trial that is best, with what cannot be told from it among the others. Of those
/// that cannot, the one with fewest unknowns is the answer: what more of them do, these do not
/// need; and of what was declared, what is least off.
fn best((candidates, screen, mut trials): Searched) -> Option<Named> {
    let least = best_of(&trials)?;
    let is_simpler = |place: &usize| {
        let (other, least) = (&trials[*place], &trials[least]);
        let is_less_off = match (off(other), off(least)) {
            (Some(other), Some(least)) => other < least,
            _ => false,
        };
        (other.own.len() < least.own.len() || is_less_off)
            && other.verdict.is_ok()
            && untold_half(least, other, &screen).is_some()
    };
    let simpler = (0..trials.len()).filter(is_simpler);
    let order = |place: &usize| {
        (
            trials[*place].own.len(),
            off(&trials[*place]).unwrap_or(0.0),
        )
    };
    let best = simpler
        .min_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(Ordering::Equal))
        .unwrap_or(least);
    let trial = trials.remove(best);
    let candidate = |response: usize| &candidates[screen.responses[response].candidate];
    let own: Vec<Candidate> = (trial.responses.iter())
        .map(|response| candidate(*response).clone())
        .collect();
    let mut equivalent = vec![Vec::new(); own.len()];
    for other in &trials {
        let Some((half, response)) = untold_half(&trial, other, &screen) else {
            continue;
        };
        let (other, own) = (candidate(response), &own[half]);
        if (&other.effect, &other.on) != (&own.effect, &own.on) {
            equivalent[half].push(other.clone());
        }
    }
    Some(Named {
        equivalent,
        half: half_way(&trial, &trials),
        candidates: own,
        trial,
    })
}

/// How far off what was declared is, in standard deviations of its prior; none if something was
/// not.
fn off(trial: &Trial) -> Option<f64> {
    let theta = &trial.fit.train.estimate.theta;
    let of = |own: &Own| Some((theta[own.place] - own.base).abs() / own.prior?);
    let all: Option<Vec<f64>> = trial.own.iter().map(of).collect();
    all.map(|all| all.into_iter().fold(0.0, f64::max))
}

/// The believed trial that leaves least; a pair only if it leaves clearly less than the best single
/// effect.
pub fn best_of(trials: &[Trial]) -> Option<usize> {
    let left = |place: &usize| trials[*place].fit.left();
    let least = |count: fn(usize) -> bool| {
        let is_such = |trial: &Trial| trial.verdict.is_ok() && count(trial.responses.len());
        let places = (0..trials.len()).filter(|place| is_such(&trials[*place]));
        places.min_by(|a, b| left(a).total_cmp(&left(b)))
    };
    match (least(|n| n == 1), least(|n| n > 1)) {
        (Some(single), Some(pair)) => {
            let is_clear = leaves_clearly_less(&trials[pair].fit, &trials[single].fit);
            Some(if is_clear { pair } else { single })
        }
        (one, two) => one.or(two),
    }
}

/// Whether a fit leaves less than another by what is asked of an effect, on both sets of
/// records.
pub fn leaves_clearly_less(one: &Fit, other: &Fit) -> bool {
    let better = 1.0 - thresholds::HELD_OUT;
    one.train.pooled < better * other.train.pooled && one.test.pooled < better * other.test.pooled
}

/// Whether a fit leaves clearly less than another: on both sets of records, or of the test records
/// for certain and of the training records no more, where the other's further unknowns help it.
fn is_clearly_better(one: &Fit, other: &Fit) -> bool {
    let told = evidence(other, one, &[]);
    let is_certain =
        told.held_out > thresholds::HELD_OUT && told.held_out_errors > thresholds::STANDARD_ERRORS;
    leaves_clearly_less(one, other) || (is_certain && one.train.pooled < other.train.pooled)
}

/// What of a trial the records do not tell from another's, if that is as large and differs in
/// nothing else: its number, and the other's response.
fn untold_half(trial: &Trial, other: &Trial, screen: &Screen) -> Option<(usize, usize)> {
    if trial.responses.len() != other.responses.len() {
        return None;
    }
    let differ = |a: &[usize], b: &[usize]| a.iter().position(|response| !b.contains(response));
    let half = differ(&trial.responses, &other.responses)?;
    let response = other.responses[differ(&other.responses, &trial.responses)?];
    let shared = trial
        .responses
        .iter()
        .filter(|own| other.responses.contains(own));
    let is_rest = shared.count() + 1 == trial.responses.len();
    let similarity = screen.similarity(trial.responses[half], response);
    (is_rest && is_untold(&trial.fit, &other.fit, similarity)).then_some((half, response))
}

/// Whether records do not tell what led to a fit from what led to another: the responses are alike,
/// and so is what the fits leave of the test records; and, but for two names of one thing, the
/// other explains the training records as well.
fn is_untold(one: &Fit, other: &Fit, similarity: f64) -> bool {
    let told = evidence(one, other, &[]);
    let (part, errors) = (told.held_out.abs(), told.held_out_errors);
    // Fits that leave the same to the last digit have no error to be judged by.
    let as_good = errors.is_nan()
        || errors.abs() < thresholds::STANDARD_ERRORS
        || part < thresholds::TOLD_APART;
    let is_told = other.train.pooled > (1.0 + thresholds::TOLD_APART) * one.train.pooled
        && told.information < -thresholds::INFORMATION;
    let is_same = similarity > thresholds::SAME && part < thresholds::HELD_OUT;
    similarity > thresholds::ALIKE && (is_same || (as_good && !is_told))
}

/// The half of a pair that was believed alone, and the test gap that it left: a step of the way.
fn half_way(best: &Trial, others: &[Trial]) -> Option<(usize, f64)> {
    if best.responses.len() < 2 {
        return None;
    }
    let halves = others.iter().filter_map(|trial| match trial.responses[..] {
        [response] if trial.verdict.is_ok() => {
            let half = best.responses.iter().position(|own| *own == response)?;
            Some((half, trial))
        }
        _ => None,
    });
    let (half, trial) = halves.min_by(|a, b| a.1.fit.left().total_cmp(&b.1.fit.left()))?;
    Some((half, trial.fit.test.pooled))
}
