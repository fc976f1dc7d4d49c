//! The search: screen, fit the most promising in earnest, believe or reject, and again, until
//! the floor is reached or nothing more is believed. What is left then may be an expression without
//! a name.

use std::collections::BTreeMap;

use model_spec::edit::{self, Edit, SetParameter};
use model_spec::source::Source;

use crate::candidates::{self, Candidate, candidates};
use crate::catalogue::Effect;
use crate::empirical::add_empirical;
use crate::fitting::{FIRST_PART, Fit, Setting};
use crate::judge::{Evidence, evidence};
use crate::named::{Named, Searched, best_of, leaves_clearly_less, named};
use crate::rule;
use crate::screen::{Screen, screen};
use crate::sites::{plays, sites};
use crate::thinned::thin;
use crate::trials::{PARTS, Round, Trial, at_floor, leaves_less};
use crate::undeclared::shifts;
use crate::unknowns::{Unknown, What, of_null_model};

/// An effect that was believed.
#[derive(Clone, Debug)]
pub struct Accepted {
    /// The effect at its place.
    pub candidate: Candidate,
    /// Which of the unknowns of the last fit are its own.
    pub unknowns: Vec<usize>,
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
    let texts = || (text.to_owned(), text.to_owned());
    // Sensors that are free from the first step on find what is off by much, and now and then
    // stand in for what parameters have not done yet: those that wait do not.
    let held = |unknown: &Unknown| match unknown.what {
        What::Parameter(_) | What::Inverse(_) => unknown.clone(),
        What::Gain(_) | What::Bias(_) | What::Delay(_) => Unknown {
            bounds: (unknown.start, unknown.start),
            ..unknown.clone()
        },
    };
    let waiting = || -> Result<Fit, String> {
        let held = unknowns.iter().map(held).collect();
        let fit = setting.fit(texts(), held, &theta)?;
        let theta = fit.train.estimate.theta.clone();
        let left = fit.train.estimate.cost;
        setting.complete(setting.expected(texts(), unknowns.clone(), theta, (&fit, left))?)
    };
    let (free, waiting) = rayon::join(|| setting.fit(texts(), unknowns.clone(), &theta), waiting);
    match (free, waiting) {
        (Ok(free), Ok(waiting)) if waiting.train.pooled < free.train.pooled => Ok(waiting),
        (Ok(fit), _) | (Err(_), Ok(fit)) => Ok(fit),
        (Err(error), Err(_)) => Err(error),
    }
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
    said: &(dyn Fn(&str) + Sync),
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
        let is_first = found.accepted.is_empty();
        let searched = round(setting, (fit, is_first), effects, floor, said);
        let mut believed: Option<Searched> = None;
        for (candidates, screen, mut trials) in searched {
            note_rejected(&mut found.rejected, &candidates, &screen, &trials);
            trials.retain(|trial| trial.verdict.is_ok());
            let least = |trials: &[Trial]| {
                let left = trials.iter().map(|trial| trial.fit.left());
                left.fold(f64::INFINITY, f64::min)
            };
            let known = believed
                .as_ref()
                .map_or(f64::INFINITY, |(_, _, known)| least(known));
            if least(&trials) < known {
                believed = Some((candidates, screen, trials));
            }
        }
        let Some((candidates, screen, mut trials)) = believed else {
            break;
        };
        if let Some(answer) = best_of(&trials) {
            Round {
                setting,
                fit: found.best(),
                candidates: &candidates,
                screen: &screen,
                is_whole: true,
                most: rule::MOST_SKETCHES,
                parts: &PARTS,
                floor,
                said,
            }
            .swap(&mut trials, answer, effects);
        }
        trials.retain(|trial| trial.verdict.is_ok());
        let searched = (candidates, screen, trials);
        let Some(named) = named(setting, found.best(), searched, floor, said) else {
            break;
        };
        accept(&mut found, named);
        thin(setting, &mut found, said);
    }
    unnamed(setting, &mut found, floor, said);
    Ok(found)
}

/// Adds an expression without a name where nothing is named: what something named leaves may be
/// its own misfit. A number that is off, and leaves much, stands in for something that varies: an
/// expression that leaves clearly less takes its place.
fn unnamed(setting: &Setting<'_>, found: &mut Found, floor: f64, said: &(dyn Fn(&str) + Sync)) {
    let is_shift = |effect: &Accepted| {
        effect.candidate.released.is_some()
            || effect.candidate.effect == candidates::PARAMETER_SHIFT
    };
    let leaves_little = leaves_less(found.best(), rule::UNNAMED_FROM * floor);
    if !found.accepted.iter().all(is_shift) || (leaves_little && found.last.is_some()) {
        return;
    }
    let (shifts, with_shifts) = (std::mem::take(&mut found.accepted), found.last.take());
    add_empirical(setting, found, floor, said);
    if let Some(with_shifts) = with_shifts {
        let is_better =
            (found.last.as_ref()).is_some_and(|last| leaves_clearly_less(last, &with_shifts));
        if !is_better {
            (found.accepted, found.last) = (shifts, Some(with_shifts));
        }
    }
}

/// How motions are looked at while candidates are screened.
#[derive(Clone, Copy, PartialEq)]
enum View {
    /// The beginnings of windows, where a motion is nearly linear in whatever changes it.
    Beginnings,
    /// Whole windows, which show more of what is slow.
    Whole,
    /// Whole windows of the model with all play closed: linear in what moves teeth by much more
    /// than their play, and blind for what is smaller.
    NoPlay,
}

impl View {
    /// The part of each window that is looked at.
    fn part(self) -> f64 {
        match self {
            Self::Beginnings => FIRST_PART.0,
            Self::Whole | Self::NoPlay => 1.0,
        }
    }
}

/// One round: view after view until what is believed leaves little, pairs if that leaves much; then
/// whether a parameter may be off that nobody called uncertain.
fn round(
    setting: &Setting<'_>,
    (fit, is_first): (&Fit, bool),
    effects: &[Effect],
    floor: f64,
    said: &(dyn Fn(&str) + Sync),
) -> Vec<Searched> {
    let is_near = fit.train.pooled < rule::FAR;
    let views: &[View] = match (setting.fits_starts(), is_near, is_first) {
        // What is small beside what was found already is seen over whole windows or not at all.
        (false, _, _) | (true, true, false) => &[View::Whole],
        (true, true, true) => &[View::Whole, View::Beginnings, View::NoPlay],
        (true, false, _) => &[View::Beginnings, View::NoPlay, View::Whole],
    };
    let round =
        |view: View, candidates: &[Candidate], screen: &Screen, singles: Option<&[Trial]>| {
            let round = Round {
                setting,
                fit,
                candidates,
                screen,
                is_whole: view == View::Whole,
                most: match view {
                    View::NoPlay => 2 * rule::FITS_AT_ONCE,
                    View::Whole | View::Beginnings => rule::MOST_SKETCHES,
                },
                // Without play a straight line is right.
                parts: match view {
                    View::NoPlay => &PARTS[..2],
                    View::Whole | View::Beginnings => &PARTS,
                },
                floor,
                said,
            };
            match singles {
                Some(singles) => round.pairs(singles),
                None => round.singles(),
            }
        };
    let is_believed = |(_, _, trials): &Searched| trials.iter().any(|trial| trial.verdict.is_ok());
    let little = (rule::CLOSE * floor).max(rule::MOST_OF * fit.left());
    let leaves_little = |trial: &Trial| trial.verdict.is_ok() && leaves_less(&trial.fit, little);
    let is_close = |(_, _, trials): &Searched| trials.iter().any(leaves_little);
    let mut searched: Vec<Searched> = Vec::new();
    let mut seen: Vec<View> = Vec::new();
    for view in views {
        // Without play everything but teeth is seen worse: it is for what nothing else explains.
        if *view == View::NoPlay && searched.iter().any(is_believed) {
            continue;
        }
        let closed = match view {
            View::NoPlay => match without_play(setting, fit) {
                Some(closed) => Some(closed),
                None => continue,
            },
            View::Whole | View::Beginnings => None,
        };
        if closed.is_some() {
            said("looking at the model without play");
        }
        let at = (closed.as_ref().unwrap_or(fit), view.part());
        let has_play = *view != View::NoPlay;
        let (candidates, screen) = screened(setting, at, (effects, has_play), floor, said);
        let trials = round(*view, &candidates, &screen, None);
        searched.push((candidates, screen, trials));
        seen.push(*view);
        if searched.iter().any(is_close) {
            break;
        }
    }
    let is_enough = |trial: &Trial| trial.verdict.is_ok() && at_floor(&trial.fit, floor);
    let is_done = |(_, _, trials): &Searched| trials.iter().any(is_enough);
    if !searched.iter().any(is_done) {
        for (view, (candidates, screen, trials)) in seen.iter().zip(&mut searched) {
            let pairs = round(*view, candidates, screen, Some(trials));
            trials.extend(pairs);
            if trials.iter().any(|trial| trial.verdict.is_ok()) {
                break;
            }
        }
    }
    let is_open = match searched.iter().any(is_believed) {
        true => is_first && !searched.iter().any(is_close),
        false => is_first || !is_near,
    };
    if is_open {
        let shifts = shifts(fit);
        said(&format!(
            "screening {} parameters of the model",
            shifts.len()
        ));
        let view = views[0];
        let screen = screen(setting, fit, &shifts, view.part());
        let mut trials = round(view, &shifts, &screen, None);
        // What nobody doubts is off only if nothing else comes near.
        let others = searched.iter().flat_map(|(_, _, trials)| trials);
        let others: Vec<&Trial> = others.filter(|trial| trial.verdict.is_ok()).collect();
        let is_clear = |trial: &Trial| {
            let clear = |other: &&Trial| leaves_clearly_less(&trial.fit, &other.fit);
            trial.verdict.is_err() || others.iter().all(clear)
        };
        trials.retain(is_clear);
        searched.push((shifts, screen, trials));
    }
    searched
}

/// The model with all play closed, fitted; none if there is no play.
fn without_play(setting: &Setting<'_>, fit: &Fit) -> Option<Fit> {
    let edits: Vec<Edit> = plays(&fit.plant.model)
        .into_iter()
        .map(|name| {
            Edit::SetParameter(SetParameter {
                name,
                value: 0.0,
                source: String::new(),
            })
        })
        .collect();
    if edits.is_empty() {
        return None;
    }
    let closed = |text: &str| edit::apply(&Source::new(setting.path.as_str(), text), &edits).ok();
    let texts = (closed(&fit.text)?, closed(&fit.linear)?);
    let theta = &fit.train.estimate.theta;
    setting.fit(texts, fit.unknowns.clone(), theta).ok()
}

/// Declared parameters and sensors that may be off by more than their priors allow.
fn released(setting: &Setting<'_>, fit: &Fit) -> Vec<Candidate> {
    let unknowns = fit
        .unknowns
        .iter()
        .filter(|unknown| unknown.prior.is_some());
    let candidate = |unknown: &Unknown| {
        let (effect, on, says, experiment) = match &unknown.what {
            What::Parameter(name) | What::Inverse(name) => (
                candidates::PARAMETER_SHIFT,
                name.clone(),
                "a parameter is off by more than was declared",
                "measure it by itself",
            ),
            What::Gain(place) => (
                "sensor_gain",
                setting.dataset.channels[*place].name.clone(),
                "a sensor shows too much or too little",
                "calibrate it over its range",
            ),
            What::Bias(place) => (
                "sensor_bias",
                setting.dataset.channels[*place].name.clone(),
                "a sensor is off by a constant",
                "read it where its quantity is known",
            ),
            What::Delay(place) => (
                "sensor_delay",
                setting.dataset.channels[*place].name.clone(),
                "a sensor is late",
                "excite it with a step that is recorded itself",
            ),
        };
        candidates::released(effect, &on, says, experiment, &unknown.what)
    };
    unknowns.map(candidate).collect()
}

/// The candidates and their responses: those that repeat with an angle, which are many, only
/// if the others leave much of the gap. Teeth that move with an angle do so by much more than
/// they deflect, and often than their play: they are looked at where all play is closed, and
/// nothing else is there.
fn screened(
    setting: &Setting<'_>,
    (fit, part): (&Fit, f64),
    (effects, has_play): (&[Effect], bool),
    floor: f64,
    said: &dyn Fn(&str),
) -> (Vec<Candidate>, Screen) {
    let model = &fit.plant.model;
    let mut all = candidates(model, effects, &sites(model), &usual_rates(setting));
    all.extend(released(setting, fit));
    all.retain(|c| (c.order.is_none() || c.on_mesh != has_play) && (has_play || c.on_mesh));
    let plain: Vec<Candidate> = all
        .iter()
        .filter(|c| c.order.is_none() || !has_play)
        .cloned()
        .collect();
    said(&format!("screening {} candidates", plain.len()));
    let found = screen(setting, fit, &plain, part);
    let best = found.responses.iter().map(|r| r.gain).fold(0.0, f64::max);
    let above = found.left(&[]).0 - floor * floor * found.numbers;
    if plain.len() == all.len() || best > rule::ENOUGH * above {
        return (plain, found);
    }
    said(&format!(
        "screening {} candidates that repeat with an angle",
        all.len() - plain.len()
    ));
    let found = screen(setting, fit, &all, part);
    (all, found)
}

/// The usual rate of every channel that is measured, by name: the root mean square of its
/// slope.
pub(crate) fn usual_rates(setting: &Setting<'_>) -> BTreeMap<String, f64> {
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

/// Takes what is named over, with the candidates that cannot be told from it.
fn accept(found: &mut Found, named: Named) {
    let (before, best) = (found.best(), named.trial);
    let gap = (before.test.pooled, best.fit.test.pooled);
    let evidence = best
        .verdict
        .unwrap_or_else(|_| evidence(before, &best.fit, &best.own));
    let accepted = named.candidates.into_iter().enumerate();
    let accepted = accepted.map(|(number, candidate)| {
        let own = best.own.iter().filter(|own| own.effect == number);
        Accepted {
            candidate,
            unknowns: own.map(|own| own.place).collect(),
            equivalent: named.equivalent[number].clone(),
            evidence: evidence.clone(),
            test_gap: match named.half {
                Some((first, between)) if first == number => (gap.0, between),
                Some((_, between)) => (between, gap.1),
                None => gap,
            },
        }
    });
    let mut accepted: Vec<Accepted> = accepted.collect();
    if named.half.is_some_and(|(first, _)| first != 0) {
        accepted.reverse();
    }
    found.accepted.extend(accepted);
    let is_accepted = |known: &Candidate| {
        let same =
            |of: &Accepted| (&of.candidate.effect, &of.candidate.on) == (&known.effect, &known.on);
        found.accepted.iter().any(same)
    };
    found
        .rejected
        .retain(|known| !is_accepted(&known.candidate));
    found.last = Some(best.fit);
}
