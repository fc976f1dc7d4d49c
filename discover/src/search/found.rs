//! The search: screen, fit the most promising in earnest, believe or reject, and again, until
//! the floor is reached or nothing more is believed. What is left then may be an expression without
//! a name.

use crate::catalogue::Effect;
use crate::catalogue::candidate::{self, Candidate};
use crate::empirical::add_empirical;
use crate::fit::full::Fit;
use crate::fit::residuals::Rest;
use crate::model::problem::Setting;
use crate::model::unknowns::{Unknown, What, of_null_model};
use crate::search::acceptance::{Evidence, evidence};
use crate::search::backward_elimination::thin;
use crate::search::fitted::{Task, Trial, at_floor, leaves_less};
use crate::search::round::Look;
use crate::search::screening::Screen;
use crate::search::selected::{Named, leaves_clearly_less};
use crate::thresholds;
use eomgen_records::windows::Windows;

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
/// Why no motion can be followed, or where it cannot.
pub fn null_fit(setting: &Setting<'_>, text: &str) -> Result<Fit, String> {
    let plant = setting.plant(text, None)?;
    let values: Vec<(String, f64)> = plant
        .parameters
        .iter()
        .cloned()
        .zip(plant.values.iter().copied())
        .collect();
    let unknowns = of_null_model(setting.dataset, plant.model(), &values);
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
    let fit = match (free, waiting) {
        (Ok(free), Ok(waiting)) if waiting.train.pooled < free.train.pooled => waiting,
        (Ok(fit), _) | (Err(_), Ok(fit)) => fit,
        (Err(error), Err(_)) => return Err(error),
    };
    followed(&setting.train, &fit.train)?;
    followed(&setting.test, &fit.test)?;
    Ok(fit)
}

/// The motion can be followed in all windows of a set.
fn followed(windows: &Windows<'_>, rest: &Rest) -> Result<(), String> {
    let Some(first) = rest.lost.first() else {
        return Ok(());
    };
    let window = &windows.list[*first];
    Err(format!(
        "the model's motion cannot be followed in {} of {} windows, first at t = {:.6} s of {}: \
         nothing can be compared there; expected a model that runs through its records",
        rest.lost.len(),
        windows.list.len(),
        window.times[0],
        windows.records[window.record].name
    ))
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
    while found.accepted.len() < thresholds::MOST_EFFECTS {
        let fit = found.last.as_ref().unwrap_or(&found.null);
        if at_floor(fit, floor) {
            break;
        }
        let look = Look {
            task: Task {
                setting,
                fit,
                floor,
                said,
            },
            is_first: found.accepted.is_empty(),
            effects,
        };
        let searched = look.round();
        for (candidates, screen, trials) in &searched {
            note_rejected(&mut found.rejected, candidates, screen, trials);
        }
        let Some(named) = look.answer(searched) else {
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
        effect.candidate.released.is_some() || effect.candidate.effect == candidate::PARAMETER_SHIFT
    };
    let leaves_little = leaves_less(found.best(), thresholds::UNNAMED_FROM * floor);
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
            None if response.visible <= thresholds::OWN_PART => note(
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
