//! What is named of a round: the believed trial that leaves least, and whatever the records do
//! not tell from it.

use crate::candidates::Candidate;
use crate::fitting::{Fit, Setting};
use crate::judge::evidence;
use crate::rule;
use crate::screen::Screen;
use crate::trials::Trial;
use crate::undeclared;

/// Candidates, what they promise, and those of them that were fitted in earnest.
pub type Searched = (Vec<Candidate>, Screen, Vec<Trial>);

/// The believed trial that is named.
pub struct Named {
    /// Its candidates, in the order of its responses.
    pub candidates: Vec<Candidate>,
    /// The trial.
    pub trial: Trial,
    /// What cannot be told from it.
    pub equivalent: Vec<Candidate>,
    /// Of a pair the half that was believed alone, by its number, and the test gap that it left.
    pub half: Option<(usize, f64)>,
}

/// What is named of the believed trials of a round; none if nothing is believed. A parameter that
/// nobody called uncertain is the less plausible answer: it is named only if it leaves clearly
/// less than what looks like it. `fit`: what the round began with.
pub fn named(
    setting: &Setting<'_>,
    fit: &Fit,
    searched: Searched,
    floor: f64,
    said: &(dyn Fn(&str) + Sync),
) -> Option<Named> {
    let named = best(searched)?;
    let [candidate] = &named.candidates[..] else {
        return Some(named);
    };
    let with = (candidate, &named.trial.fit);
    let Some(((candidates, screen, trials), own)) =
        undeclared::beside(setting, fit, candidate, floor, said)
    else {
        return Some(named);
    };
    let (better, others): (Vec<Trial>, Vec<Trial>) = trials
        .into_iter()
        .partition(|trial| leaves_clearly_less(&trial.fit, with.1));
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
    Some(Named {
        equivalent: [named.equivalent, undeclared].concat(),
        ..named
    })
}

/// The believed trial that is best, with what cannot be told from it among the others.
fn best((candidates, screen, mut trials): Searched) -> Option<Named> {
    let trial = trials.remove(best_of(&trials)?);
    let candidate = |response: usize| &candidates[screen.responses[response].candidate];
    let own: Vec<Candidate> = trial
        .responses
        .iter()
        .map(|response| candidate(*response).clone())
        .collect();
    let is_other = |other: &Candidate| (&other.effect, &other.on) != (&own[0].effect, &own[0].on);
    let equivalent = indistinct(&trial, &trials, &screen)
        .into_iter()
        .map(|response| candidate(response).clone());
    Some(Named {
        equivalent: equivalent.filter(is_other).collect(),
        half: half_way(&trial, &trials),
        candidates: own,
        trial,
    })
}

/// The trial that leaves least; a pair only if it leaves clearly less than the best single
/// effect.
pub fn best_of(trials: &[Trial]) -> Option<usize> {
    let left = |place: &usize| trials[*place].fit.left();
    let least = |count: fn(usize) -> bool| {
        let places = (0..trials.len()).filter(|place| count(trials[*place].responses.len()));
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
fn leaves_clearly_less(one: &Fit, other: &Fit) -> bool {
    let better = 1.0 - rule::HELD_OUT;
    one.train.pooled < better * other.train.pooled && one.test.pooled < better * other.test.pooled
}

/// Of the others, those single ones that the records do not tell from the best one: their
/// responses.
fn indistinct(best: &Trial, others: &[Trial], screen: &Screen) -> Vec<usize> {
    let [own] = best.responses[..] else {
        return Vec::new();
    };
    let untold = |other: &Trial| match other.responses[..] {
        [response] => {
            let similarity = screen.similarity(own, response);
            is_untold(&best.fit, &other.fit, similarity).then_some(response)
        }
        _ => None,
    };
    others.iter().filter_map(untold).collect()
}

/// Whether records do not tell what led to two fits: the responses are alike, and so is what the
/// fits leave of the test records.
fn is_untold(one: &Fit, other: &Fit, similarity: f64) -> bool {
    let told = evidence(one, other, &[]);
    let (part, errors) = (told.held_out.abs(), told.held_out_errors);
    // Fits that leave the same to the last digit have no error to be judged by.
    let as_good = errors.is_nan()
        || errors.abs() < rule::STANDARD_ERRORS
        || part < rule::TOLD_APART
        || (similarity > rule::SAME && part < rule::HELD_OUT);
    similarity > rule::ALIKE && as_good
}

/// The half of a pair that was believed alone, and the test gap that it left: a step of the way.
fn half_way(best: &Trial, others: &[Trial]) -> Option<(usize, f64)> {
    if best.responses.len() < 2 {
        return None;
    }
    let halves = others.iter().filter_map(|trial| match trial.responses[..] {
        [response] => {
            let half = best.responses.iter().position(|own| *own == response)?;
            Some((half, trial))
        }
        _ => None,
    });
    let (half, trial) = halves.min_by(|a, b| a.1.fit.left().total_cmp(&b.1.fit.left()))?;
    Some((half, trial.fit.test.pooled))
}
