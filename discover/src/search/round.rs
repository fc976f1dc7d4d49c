//! One round of the search: motions looked at in one view after the other until what is believed
//! leaves little, pairs if that leaves much, and parameters that nobody called uncertain; and what
//! is named of all that.

use std::collections::BTreeMap;

use model_spec::edit::{self, Edit, SetParameter};
use model_spec::model::Model;
use model_spec::source::Source;

use crate::catalogue::Effect;
use crate::catalogue::candidate::{self, Candidate, candidates};
use crate::catalogue::sites::{plays, sites};
use crate::fit::full::Fit;
use crate::model::problem::{FIRST_PART, Setting};
use crate::model::unknowns::{Unknown, What};
use crate::search::fitted::{PARTS, Round, Task, Trial, at_floor};
use crate::search::parameter_offsets::shifts;
use crate::search::screening::{Screen, screen};
use crate::search::selected::{Named, Searched, best_of, leaves_clearly_less, named};
use crate::thresholds;
use eomgen_records::dataset::Quantity;

/// How motions are looked at while candidates are screened.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum View {
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

/// What a round works with.
pub struct Look<'l> {
    /// What the round is about.
    pub task: Task<'l>,
    /// Whether nothing was found yet.
    pub is_first: bool,
    /// The catalogue.
    pub effects: &'l [Effect],
}

impl Look<'_> {
    /// All that was looked at.
    pub fn round(&self) -> Vec<Searched> {
        let mut searched: Vec<Searched> = Vec::new();
        let mut seen: Vec<View> = Vec::new();
        let mut has_shifts = false;
        for view in self.views() {
            if *view == View::NoPlay {
                // Without play everything but teeth is seen worse: it is for what nothing else
                // explains.
                if is_any(&searched, &|trial| trial.verdict.is_ok()) {
                    continue;
                }
                // Teeth are fitted slowly: a parameter that explains all saves that.
                if self.is_first && !self.task.is_near() {
                    searched.push(self.shifts());
                    has_shifts = true;
                    if is_any(&searched, &|trial| self.is_enough(trial)) {
                        break;
                    }
                }
            }
            let Some(found) = self.looked(*view) else {
                continue;
            };
            let place = seen.len();
            searched.insert(place, found);
            seen.push(*view);
            // Near the floor another look is quick, and what is nearly as good may be the answer.
            let is_done = match self.task.is_near() {
                true => is_any(&searched, &|trial| self.is_enough(trial)),
                false => is_any(&searched, &|trial| self.is_close(trial)),
            };
            if is_done {
                break;
            }
        }
        if !is_any(&searched, &|trial| self.is_enough(trial)) {
            self.add_pairs(&seen, &mut searched);
        }
        let is_open = match is_any(&searched, &|trial| trial.verdict.is_ok()) {
            true => self.is_first && !is_any(&searched, &|trial| self.is_close(trial)),
            false => self.is_first || !self.task.is_near(),
        };
        if is_open && !has_shifts {
            searched.push(self.shifts());
            has_shifts = true;
        }
        if has_shifts {
            keep_clear(&mut searched);
        }
        searched
    }

    /// What is named of all that was looked at; none if nothing is believed, alone or together.
    pub fn answer(&self, mut searched: Vec<Searched>) -> Option<Named> {
        let least = |searched: &Searched| {
            let believed = searched.2.iter().filter(|trial| trial.verdict.is_ok());
            let left = believed.map(|trial| trial.fit.left());
            left.fold(f64::INFINITY, f64::min)
        };
        let best = (0..searched.len())
            .filter(|place| least(&searched[*place]).is_finite())
            .min_by(|a, b| least(&searched[*a]).total_cmp(&least(&searched[*b])));
        let Some(best) = best else {
            return self.is_first.then(|| self.together(&searched)).flatten();
        };
        let (candidates, screen, mut trials) = searched.swap_remove(best);
        trials.retain(|trial| trial.explains);
        if let Some(answer) = best_of(&trials) {
            let round = self.task.round(&candidates, &screen, true);
            round.swap(&mut trials, answer, self.effects);
        }
        trials.retain(|trial| trial.explains);
        named(self.task, (candidates, screen, trials))
    }

    fn views(&self) -> &'static [View] {
        match (
            self.task.setting.fits_starts(),
            self.task.is_near(),
            self.is_first,
        ) {
            // What is small beside what was found already is seen over whole windows or not at
            // all.
            (false, _, _) | (true, true, false) => &[View::Whole],
            (true, true, true) => &[View::Whole, View::Beginnings, View::NoPlay],
            (true, false, _) => &[View::Beginnings, View::NoPlay, View::Whole],
        }
    }

    /// Whether a trial is believed and leaves little.
    fn is_close(&self, trial: &Trial) -> bool {
        trial.verdict.is_ok() && self.task.explains_most(&trial.fit)
    }

    /// Whether a trial is believed and leaves no more than a right model would.
    fn is_enough(&self, trial: &Trial) -> bool {
        trial.verdict.is_ok() && at_floor(&trial.fit, self.task.floor)
    }

    /// Candidates screened in a view and fitted one by one: what repeats with an angle only if the
    /// others promise little, or come to little. None if the model has no play to be closed.
    pub(crate) fn looked(&self, view: View) -> Option<Searched> {
        let closed = match view {
            View::NoPlay => Some(without_play(self.task.setting, self.task.fit)?),
            View::Whole | View::Beginnings => None,
        };
        if closed.is_some() {
            (self.task.said)("looking at the model without play");
        }
        let fit = closed.as_ref().unwrap_or(self.task.fit);
        let (mut candidates, repeating) = self.candidates(fit, view);
        (self.task.said)(&format!("screening {} candidates", candidates.len()));
        let screened = screen(self.task.setting, fit, &candidates, view.part());
        let (mut from, mut trials) = (0, Vec::new());
        if repeating.is_empty() || self.promises_enough(&screened) {
            trials = self.begun(view, &candidates, &screened).singles(0);
            if repeating.is_empty() || trials.iter().any(|trial| self.is_close(trial)) {
                return Some((candidates, screened, trials));
            }
            from = candidates.len();
        }
        (self.task.said)(&format!(
            "screening {} candidates that repeat with an angle",
            repeating.len()
        ));
        // Behind the others, so that what was fitted keeps its place.
        candidates.extend(repeating);
        let screened = screen(self.task.setting, fit, &candidates, view.part());
        trials.extend(self.begun(view, &candidates, &screened).singles(from));
        Some((candidates, screened, trials))
    }

    /// Fits of candidates in a view.
    fn begun<'r>(
        &'r self,
        view: View,
        candidates: &'r [Candidate],
        screen: &'r Screen,
    ) -> Round<'r> {
        let round = self.task.round(candidates, screen, view == View::Whole);
        match view {
            // Without play a straight line is right.
            View::NoPlay => Round {
                most: 2 * thresholds::FITS_AT_ONCE,
                parts: &PARTS[..2],
                ..round
            },
            View::Whole | View::Beginnings => round,
        }
    }

    /// Adds pairs, view after view until some are believed.
    fn add_pairs(&self, seen: &[View], searched: &mut [Searched]) {
        for (view, (candidates, screen, trials)) in seen.iter().zip(searched) {
            let pairs = self.begun(*view, candidates, screen).pairs(trials);
            trials.extend(pairs);
            if trials.iter().any(|trial| trial.verdict.is_ok()) {
                break;
            }
        }
    }

    /// Parameters that nobody called uncertain.
    fn shifts(&self) -> Searched {
        let shifts = shifts(self.task.fit);
        (self.task.said)(&format!(
            "screening {} parameters of the model",
            shifts.len()
        ));
        let view = self.views()[0];
        let screen = screen(self.task.setting, self.task.fit, &shifts, view.part());
        let trials = self.begun(view, &shifts, &screen).singles(0);
        (shifts, screen, trials)
    }

    /// The candidates of a view, and those that repeat with an angle, which are many. Teeth that
    /// move with an angle do so by much more than they deflect, and often than their play: they are
    /// looked at where all play is closed, and nothing else is there.
    fn candidates(&self, fit: &Fit, view: View) -> (Vec<Candidate>, Vec<Candidate>) {
        let (setting, has_play) = (self.task.setting, view != View::NoPlay);
        let model = fit.plant.model();
        let mut all = candidates(
            model,
            self.effects,
            &sites(model),
            &usual_rates(setting, model),
        );
        all.extend(released(setting, fit));
        all.retain(|c| (c.order.is_none() || c.on_mesh != has_play) && (has_play || c.on_mesh));
        all.into_iter()
            .partition(|c| c.order.is_none() || !has_play)
    }

    /// Whether one of the screened promises most of the gap.
    fn promises_enough(&self, screen: &Screen) -> bool {
        let best = screen.responses.iter().map(|r| r.gain).fold(0.0, f64::max);
        let floor = self.task.floor * self.task.floor * screen.numbers;
        best > thresholds::ENOUGH * (screen.left(&[]).0 - floor)
    }
}

/// What nobody doubts, which stands last, is off only if nothing else that is believed comes near.
fn keep_clear(searched: &mut [Searched]) {
    let Some(((_, _, shifts), searched)) = searched.split_last_mut() else {
        return;
    };
    let others = searched.iter().flat_map(|(_, _, trials)| trials);
    let others: Vec<&Trial> = others.filter(|trial| trial.verdict.is_ok()).collect();
    shifts.retain(|trial| {
        let is_clear = |other: &&Trial| leaves_clearly_less(&trial.fit, &other.fit);
        trial.verdict.is_err() || others.iter().all(is_clear)
    });
}

/// Whether any trial is such.
fn is_any(searched: &[Searched], is: &dyn Fn(&Trial) -> bool) -> bool {
    searched.iter().any(|(_, _, trials)| trials.iter().any(is))
}

/// The model with all play closed, fitted; none if there is no play.
fn without_play(setting: &Setting<'_>, fit: &Fit) -> Option<Fit> {
    let edits: Vec<Edit> = plays(fit.plant.model())
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
                candidate::PARAMETER_SHIFT,
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
        candidate::released(effect, &on, says, experiment, &unknown.what)
    };
    unknowns.map(candidate).collect()
}

/// The usual rate of every observable and coordinate that is measured, by its name in the model: the
/// root mean square of its slope, or of the rate itself where that is measured.
pub(crate) fn usual_rates(setting: &Setting<'_>, model: &Model) -> BTreeMap<String, f64> {
    let record = &setting.dataset.train[0];
    let mut rates = BTreeMap::new();
    let channels = setting.dataset.channels.iter().zip(&record.channels);
    for (channel, column) in channels {
        let smooth = crate::model::smoothing::smoothed(&record.times, column);
        let (name, slopes) = match channel.quantity {
            Quantity::Rate(place) => (&model.coordinates[place].name, smooth),
            Quantity::Observable(place) => (
                &model.observables[place].name,
                crate::model::smoothing::sloped(&record.times, &smooth),
            ),
            Quantity::Coordinate(place) => (
                &model.coordinates[place].name,
                crate::model::smoothing::sloped(&record.times, &smooth),
            ),
        };
        let square = slopes.iter().map(|s| s * s).sum::<f64>() / slopes.len() as f64;
        rates.insert(name.clone(), square.sqrt());
    }
    rates
}
