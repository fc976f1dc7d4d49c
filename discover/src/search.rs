//! The search: screen, fit the most promising in earnest, believe or reject, and again, until
//! the floor is reached or nothing more is believed.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::candidates::{Candidate, candidates};
use crate::catalogue::Effect;
use crate::fitting::{Fit, Setting, Sketch};
use crate::judge::{Evidence, evidence, judge};
use crate::plant::is_linear;
use crate::rule;
use crate::screen::{Response, Screen, screen};
use crate::sites::sites;
use crate::unknowns::{What, of_null_model};

/// Parts of the size that screening promises at which a fit begins, one after the other.
const SHORTENED: [f64; 3] = [1.0, 0.3, 0.1];

/// A fit that leaves less than this part of the squares has begun well.
const WELL_BEGUN: f64 = 0.2;

/// An effect that was believed.
#[derive(Clone, Debug)]
pub struct Accepted {
    /// The effect at its place.
    pub candidate: Candidate,
    /// Which of the unknowns of the last fit are its own.
    pub unknowns: std::ops::Range<usize>,
    /// Those that could not be told from it.
    pub equivalent: Vec<Candidate>,
    /// What spoke for it when it was added.
    pub evidence: Evidence,
    /// The test gap before it was added and after, in noises.
    pub test_gap: (f64, f64),
}

/// A candidate that was not believed, and why.
#[derive(Clone, Debug)]
pub struct Rejected {
    /// The effect at its place.
    pub candidate: Candidate,
    /// Why.
    pub reason: String,
    /// Whether the record could not have shown it.
    pub not_testable: bool,
}

/// What the search found.
pub struct Found {
    /// The model with its declared unknowns alone.
    pub null: Fit,
    /// The model with everything that was believed; none if that is nothing.
    pub last: Option<Fit>,
    /// What was believed, in the order in which it was.
    pub accepted: Vec<Accepted>,
    /// What was not.
    pub rejected: Vec<Rejected>,
}

impl Found {
    /// The fit with everything that was believed.
    pub fn best(&self) -> &Fit {
        self.last.as_ref().unwrap_or(&self.null)
    }
}

/// A set of candidates fitted in earnest.
struct Trial {
    responses: Vec<usize>,
    fit: Fit,
    verdict: Result<Evidence, String>,
}

/// Fits the model with its declared unknowns alone.
///
/// # Errors
/// Why no motion can be followed.
pub fn null_fit(setting: &Setting<'_>, text: &str) -> Result<Fit, String> {
    let plant = setting.plant(text, None)?;
    let values: Vec<(String, f64)> = plant
        .parameters
        .iter()
        .cloned()
        .zip(plant.values.iter().copied())
        .collect();
    let unknowns = of_null_model(setting.dataset, &plant.model, &values);
    let theta: Vec<f64> = unknowns.iter().map(|unknown| unknown.start).collect();
    setting.fit((text.to_owned(), text.to_owned()), unknowns, &theta)
}

/// Searches for what a model lacks. `floor`: the gap that a right model would leave, in noises.
/// `said` is told what is being done.
///
/// # Errors
/// Why no motion can be followed.
pub fn search(
    setting: &Setting<'_>,
    null: Fit,
    effects: &[Effect],
    floor: f64,
    said: &dyn Fn(&str),
) -> Result<Found, String> {
    let mut found = Found {
        null,
        last: None,
        accepted: Vec::new(),
        rejected: Vec::new(),
    };
    while found.accepted.len() < rule::MOST_EFFECTS {
        let fit = found.best();
        if at_floor(fit, floor) {
            break;
        }
        let (candidates, screen) = screened(setting, fit, effects, floor, said);
        let trials = trials(setting, fit, &candidates, &screen, floor, said);
        note_rejected(&mut found.rejected, &candidates, &screen, &trials);
        let mut believed = trials;
        believed.retain(|trial| trial.verdict.is_ok());
        believed.sort_by(|a, b| a.fit.train.pooled.total_cmp(&b.fit.train.pooled));
        if believed.is_empty() {
            break;
        }
        let best = believed.remove(0);
        let equivalent = indistinct(&best, &believed, &screen);
        let equivalent = equivalent.map(|place| candidates[place].clone()).collect();
        accept(&mut found, &candidates, &screen, best, equivalent);
    }
    Ok(found)
}

/// Which candidates the record does not tell from the best one: their responses are alike, and
/// so is what they leave of the test records.
fn indistinct<'t>(
    best: &'t Trial,
    others: &'t [Trial],
    screen: &'t Screen,
) -> impl Iterator<Item = usize> + 't {
    let single = |trial: &Trial| match trial.responses[..] {
        [response] => Some(response),
        _ => None,
    };
    others.iter().filter_map(move |other| {
        let (a, b) = (single(best)?, single(other)?);
        let errors = evidence(&best.fit, &other.fit, other.fit.unknowns.len(), &[]).held_out_errors;
        let alike = screen.similarity(a, b) > rule::ALIKE;
        // Fits that leave the same to the last digit have no error to be judged by.
        let as_good = errors.is_nan() || errors.abs() < rule::STANDARD_ERRORS;
        (alike && as_good).then(|| screen.responses[b].candidate)
    })
}

/// Whether a fit leaves no more than a right model would.
pub fn at_floor(fit: &Fit, floor: f64) -> bool {
    fit.train.pooled.max(fit.test.pooled) < rule::AT_FLOOR * floor
}

/// The candidates and their responses: those that repeat with an angle, which are many, only
/// if the others leave much of the gap.
fn screened(
    setting: &Setting<'_>,
    fit: &Fit,
    effects: &[Effect],
    floor: f64,
    said: &dyn Fn(&str),
) -> (Vec<Candidate>, Screen) {
    let model = &fit.plant.model;
    let all = candidates(model, effects, &sites(model), &usual_rates(setting));
    let plain: Vec<Candidate> = all.iter().filter(|c| c.order.is_none()).cloned().collect();
    said(&format!("screening {} candidates", plain.len()));
    let found = screen(setting, fit, &plain);
    let best = found.responses.iter().map(|r| r.gain).fold(0.0, f64::max);
    let above = found.left(&[]).0 - floor * floor * found.numbers;
    if plain.len() == all.len() || best > rule::ENOUGH * above {
        return (plain, found);
    }
    said(&format!(
        "screening {} candidates that repeat with an angle",
        all.len() - plain.len()
    ));
    let found = screen(setting, fit, &all);
    (all, found)
}

/// The usual rate of every channel that is measured, by name: the root mean square of its
/// slope.
fn usual_rates(setting: &Setting<'_>) -> BTreeMap<String, f64> {
    let record = &setting.dataset.train[0];
    let channels = setting.dataset.channels.iter().zip(&record.channels);
    channels
        .map(|(channel, column)| {
            let smooth = crate::smooth::smoothed(&record.times, column);
            let slopes = crate::smooth::sloped(&record.times, &smooth);
            let square = slopes.iter().map(|s| s * s).sum::<f64>() / slopes.len() as f64;
            (channel.name.clone(), square.sqrt())
        })
        .collect()
}

/// The candidates fitted in earnest: the best alone, those that look like it, and a pair where
/// that promises more.
fn trials(
    setting: &Setting<'_>,
    fit: &Fit,
    candidates: &[Candidate],
    screen: &Screen,
    floor: f64,
    said: &dyn Fn(&str),
) -> Vec<Trial> {
    let alone = screen.left(&[]).0;
    let promise = match alone > rule::FAR * rule::FAR * screen.numbers {
        true => rule::PROMISE_FAR,
        false => rule::PROMISE,
    };
    let mut ranked: Vec<usize> = (0..screen.responses.len())
        .filter(|r| {
            let response = &screen.responses[*r];
            response.visible > rule::OWN_PART && response.gain > promise * alone
        })
        .collect();
    ranked.sort_by(|a, b| {
        screen.responses[*b]
            .gain
            .total_cmp(&screen.responses[*a].gain)
    });
    if let Some(best) = ranked.first() {
        let best = &candidates[screen.responses[*best].candidate];
        let count = ranked.len();
        said(&format!(
            "{count} promise enough to be fitted, {} most",
            best.label()
        ));
    }
    let mut sets: Vec<Set> = Vec::new();
    for response in &ranked {
        let of = &candidates[screen.responses[*response].candidate];
        // Of the orders of one effect at one place the two best are enough.
        let same = sets.iter().flat_map(|set| &set.responses).filter(|known| {
            let known = &candidates[screen.responses[**known].candidate];
            known.effect == of.effect && known.on == of.on
        });
        if same.count() < 2 && sets.len() < rule::MOST_SKETCHES {
            sets.push(Set {
                sizes: screen.left(&[*response]).1,
                responses: vec![*response],
                deleted: None,
            });
        }
    }
    let mut sketches = sketched(setting, fit, candidates, screen, sets, said);
    let best = sketches.first().map_or(0.0, |(_, sketch)| sketch.left);
    let mut trials: Vec<Trial> = Vec::new();
    let mut fits = 0;
    while !sketches.is_empty() && fits < rule::MOST_FITS {
        // Once one is believed, only what is nearly as good or looks like it may be another
        // answer.
        let believed = trials.iter().find(|trial| trial.verdict.is_ok());
        let count = sketches.len().min(rule::FITS_AT_ONCE);
        let next: Vec<(Set, Sketch)> = sketches.drain(..count).collect();
        let is_rival = |(set, sketch): &(Set, Sketch)| {
            let near = sketch.left < rule::RIVAL * best;
            let alike = |trial: &Trial| {
                screen.similarity(trial.responses[0], set.responses[0]) > rule::ALIKE
            };
            match believed {
                Some(trial) => alike(trial) || (near && !at_floor(&trial.fit, floor)),
                None => near,
            }
        };
        let wanted: Vec<(Set, Sketch)> = next.into_iter().filter(is_rival).collect();
        fits += wanted.len();
        trials.extend(completed(setting, fit, candidates, screen, wanted, said));
    }
    if trials.iter().all(|trial| trial.verdict.is_err()) {
        let pairs = best_pairs(screen, fit, candidates, &ranked);
        let pairs = sketched(setting, fit, candidates, screen, pairs, said);
        trials.extend(completed(setting, fit, candidates, screen, pairs, said));
    }
    trials
}

/// The names of a set's candidates.
fn label(candidates: &[Candidate], screen: &Screen, set: &Set) -> String {
    let labels = set
        .responses
        .iter()
        .map(|r| candidates[screen.responses[*r].candidate].label());
    labels.collect::<Vec<_>>().join(" and ")
}

/// Sets of candidates fitted to the beginnings of the windows, side by side; the best first.
fn sketched(
    setting: &Setting<'_>,
    fit: &Fit,
    candidates: &[Candidate],
    screen: &Screen,
    sets: Vec<Set>,
    said: &dyn Fn(&str),
) -> Vec<(Set, Sketch)> {
    let alone = screen.left(&[]).0;
    let sketches: Vec<Result<Sketch, String>> = sets
        .par_iter()
        .map(|set| {
            let chosen: Vec<&Response> = set
                .responses
                .iter()
                .map(|r| &screen.responses[*r])
                .collect();
            // What a straight line promises may be far beyond where it leads.
            let mut best: Result<Sketch, String> = Err("no motion can be followed".to_owned());
            for part in SHORTENED {
                let sizes = set.sizes.iter().map(|size| part * size).collect();
                let found = sketch_with(setting, fit, candidates, &chosen, (set.deleted, sizes));
                let left = best.as_ref().map_or(f64::INFINITY, |best| best.left);
                if found.as_ref().is_ok_and(|found| found.left < left) || best.is_err() {
                    best = found;
                }
                if best
                    .as_ref()
                    .is_ok_and(|best| best.left < WELL_BEGUN * alone)
                {
                    break;
                }
            }
            best
        })
        .collect();
    let mut found = Vec::new();
    for (set, sketch) in sets.into_iter().zip(sketches) {
        let label = label(candidates, screen, &set);
        match sketch {
            Ok(sketch) => {
                let part = 100.0 * sketch.left / alone;
                said(&format!(
                    "  {label}: {part:.1} % left of the beginnings of windows"
                ));
                found.push((set, sketch));
            }
            Err(error) => said(&format!("  {label}: {error}")),
        }
    }
    found.sort_by(|a, b| a.1.left.total_cmp(&b.1.left));
    found
}

/// Sketches fitted in earnest, side by side.
fn completed(
    setting: &Setting<'_>,
    fit: &Fit,
    candidates: &[Candidate],
    screen: &Screen,
    sketches: Vec<(Set, Sketch)>,
    said: &dyn Fn(&str),
) -> Vec<Trial> {
    let fits: Vec<(Set, Result<Fit, String>)> = sketches
        .into_par_iter()
        .map(|(set, sketch)| (set, setting.complete(sketch)))
        .collect();
    let mut trials = Vec::new();
    for (set, new) in fits {
        let label = label(candidates, screen, &set);
        match new {
            Ok(new) => {
                let shapes: Vec<bool> = set
                    .responses
                    .iter()
                    .flat_map(|r| screen.responses[*r].trials.iter().map(|t| t.is_shape))
                    .collect();
                let verdict = judge(fit, &new, fit.unknowns.len(), &shapes);
                let outcome = verdict.as_ref().err().map_or("believed", String::as_str);
                let (train, test) = (new.train.pooled, new.test.pooled);
                said(&format!(
                    "  {label}: {train:.2} noises are left in training, {test:.2} in test; {outcome}"
                ));
                trials.push(Trial {
                    responses: set.responses,
                    fit: new,
                    verdict,
                });
            }
            Err(error) => said(&format!("  {label}: {error}")),
        }
    }
    trials
}

/// Candidates to be fitted together, and a parameter whose term they replace.
struct Set {
    responses: Vec<usize>,
    deleted: Option<usize>,
    sizes: Vec<f64>,
}

/// The pair that promises clearly more than the best single candidate, and for each term of
/// the model that may go the pair that takes its place best. What repeats with an angle is not
/// paired: of that there is so much that two of it are lucky.
fn best_pairs(screen: &Screen, fit: &Fit, candidates: &[Candidate], ranked: &[usize]) -> Vec<Set> {
    let best = ranked.first().map_or(0.0, |r| screen.responses[*r].gain);
    let alone = screen.left(&[]).0;
    // What is nothing alone may be half of a pair: friction of two kinds in place of a third.
    let few: Vec<usize> = (0..screen.responses.len())
        .filter(|r| {
            let response = &screen.responses[*r];
            candidates[response.candidate].order.is_none() && response.visible > rule::OWN_PART
        })
        .collect();
    let mut screens = vec![(None, screen.clone())];
    for (place, unknown) in fit.unknowns.iter().enumerate() {
        let value = fit.train.estimate.theta[place];
        let near = unknown
            .prior
            .is_some_and(|(mean, sd)| mean.abs() < rule::PRIOR_REACH * sd);
        if matches!(unknown.what, What::Parameter(_)) && near {
            screens.extend(
                screen
                    .without(place, value)
                    .map(|screen| (Some(place), screen)),
            );
        }
    }
    let best_of = |deleted: Option<usize>, screen: &Screen| {
        let mut found: Option<(f64, Set)> = None;
        for (number, a) in few.iter().enumerate() {
            for b in &few[number + 1..] {
                let responses = vec![*a, *b];
                let (left, sizes) = screen.left(&responses);
                let gain = alone - left;
                let better = found.as_ref().is_none_or(|(g, _)| gain > *g);
                if sizes.iter().all(|v| *v != 0.0) && better {
                    let set = Set {
                        responses,
                        deleted,
                        sizes,
                    };
                    found = Some((gain, set));
                }
            }
        }
        // What replaces a term is far from where it was linearised: it is not held to a promise.
        let promising = |gain: f64| deleted.is_some() || gain > rule::PAIR_PROMISE * best;
        found
            .filter(|(gain, _)| promising(*gain))
            .map(|(_, set)| set)
    };
    screens
        .iter()
        .filter_map(|(deleted, screen)| best_of(*deleted, screen))
        .collect()
}

/// A sketch with some candidates more.
fn sketch_with(
    setting: &Setting<'_>,
    fit: &Fit,
    candidates: &[Candidate],
    responses: &[&Response],
    (deleted, sizes): (Option<usize>, Vec<f64>),
) -> Result<Sketch, String> {
    let (mut text, mut linear) = (fit.text.clone(), fit.linear.clone());
    let mut unknowns = fit.unknowns.clone();
    // Parameters and sensors that took up what the effect does begin anew.
    let known = unknowns.iter().zip(&fit.train.estimate.theta);
    let mut theta: Vec<f64> = known
        .map(|(unknown, value)| unknown.prior.map_or(*value, |(mean, _)| mean))
        .collect();
    if let Some(place) = deleted {
        unknowns[place].bounds = (0.0, 0.0);
        theta[place] = 0.0;
    }
    let mut sizes = sizes.iter();
    for response in responses {
        let candidate = &candidates[response.candidate];
        let mut values = Vec::new();
        for trial in &response.trials {
            let size = if trial.is_shape {
                trial.unknown.start
            } else {
                sizes.next().copied().unwrap_or(0.0)
            };
            let size = if size == 0.0 {
                trial.unknown.scale
            } else {
                size
            };
            let size = trial.unknown.admissible(size);
            values.push(if matches!(trial.unknown.what, What::Inverse(_)) {
                1.0 / size
            } else {
                size
            });
            let mut unknown = trial.unknown.clone();
            unknown.scale = size.abs().max(1e-3 * unknown.scale);
            unknowns.push(unknown);
            theta.push(size);
        }
        text = candidate
            .written(&text, &setting.path, &values, "")
            .map_err(|e| e.to_string())?;
        // What is linear between switches itself belongs to the linear part.
        if let Ok(extended) = candidate.written(&linear, &setting.path, &values, "")
            && is_linear(&extended, &setting.path, setting.order)
        {
            linear = extended;
        }
    }
    setting.sketch((text, linear), unknowns, &theta)
}

fn note_rejected(
    rejected: &mut Vec<Rejected>,
    candidates: &[Candidate],
    screen: &Screen,
    trials: &[Trial],
) {
    let mut note = |candidate: &Candidate, reason: String, not_testable: bool| {
        rejected.retain(|known: &Rejected| known.candidate.label() != candidate.label());
        rejected.push(Rejected {
            candidate: candidate.clone(),
            reason,
            not_testable,
        });
    };
    for (candidate, reason) in &screen.silent {
        note(&candidates[*candidate], reason.clone(), true);
    }
    for (place, response) in screen.responses.iter().enumerate() {
        let candidate = &candidates[response.candidate];
        let tried = trials.iter().find(|trial| trial.responses == [place]);
        match tried.map(|trial| &trial.verdict) {
            Some(Err(reason)) => note(candidate, reason.clone(), false),
            Some(Ok(_)) => {}
            None if response.visible <= rule::OWN_PART => note(
                candidate,
                format!(
                    "{:.1} % of what it does can be done by initial states, refitted parameters and sensors as well",
                    100.0 * (1.0 - response.visible)
                ),
                true,
            ),
            None => note(
                candidate,
                "others explain the difference better".to_owned(),
                false,
            ),
        }
    }
}

/// Takes a trial over, with the candidates that cannot be told from it.
fn accept(
    found: &mut Found,
    candidates: &[Candidate],
    screen: &Screen,
    best: Trial,
    equivalent: Vec<Candidate>,
) {
    let before = found.best();
    let mut first = before.unknowns.len();
    let before_gap = before.test.pooled;
    let gap = (before_gap, best.fit.test.pooled);
    let shapes = vec![false; best.fit.unknowns.len() - first];
    let evidence = best
        .verdict
        .clone()
        .unwrap_or_else(|_| evidence(before, &best.fit, first, &shapes));
    for response in &best.responses {
        let response = &screen.responses[*response];
        let unknowns = first..first + response.trials.len();
        first = unknowns.end;
        let candidate = candidates[response.candidate].clone();
        found
            .rejected
            .retain(|known| known.candidate.label() != candidate.label());
        found.accepted.push(Accepted {
            candidate,
            unknowns,
            equivalent: equivalent.clone(),
            evidence: evidence.clone(),
            test_gap: gap,
        });
    }
    found.last = Some(best.fit);
}
