//! Candidates, alone or in pairs, fitted in earnest: those that screening promises most of, as
//! far as they are worth it. Where they come from is [`crate::search::found`]'s, whether they are
//! believed [`crate::search::acceptance`]'s.

use rayon::prelude::*;

use crate::catalogue::candidate::Candidate;
use crate::fit::full::Fit;
use crate::fit::preliminary::Sketch;
use crate::model::problem::Setting;
use crate::search::acceptance::{Evidence, Own, explains, judge};
use crate::search::hypothesis::Set;
use crate::search::screening::Screen;
use crate::thresholds;

/// Parts of the size that screening promises among which a fit begins with the best: a straight
/// line leads far beyond where impacts fold the outputs, and not far enough where an effect
/// that grows does less and less.
pub const PARTS: [f64; 5] = [1.0, 0.3, 0.1, 3.0, 10.0];

/// A set of candidates fitted in earnest.
pub struct Trial {
    /// Their places among the screened.
    pub responses: Vec<usize>,
    /// Their unknowns.
    pub own: Vec<Own>,
    /// The fit with them.
    pub fit: Fit,
    /// Whether they are believed.
    pub verdict: Result<Evidence, String>,
    /// Whether they explain the records, though their sizes may be uncertain: another name of what
    /// is believed.
    pub explains: bool,
}

/// What a round of the search is about.
#[derive(Clone, Copy)]
pub struct Task<'r> {
    /// The dataset.
    pub setting: &'r Setting<'r>,
    /// The fit to be bettered.
    pub fit: &'r Fit,
    /// What a right model would leave, in noises.
    pub floor: f64,
    /// Is told what is done.
    pub said: &'r (dyn Fn(&str) + Sync),
}

/// Candidates to be fitted.
pub struct Round<'r> {
    /// What it is about.
    pub task: Task<'r>,
    /// The candidates.
    pub candidates: &'r [Candidate],
    /// What they promise.
    pub screen: &'r Screen,
    /// Whether that was seen over whole windows.
    pub is_whole: bool,
    /// The most candidates that are begun.
    pub most: usize,
    /// Parts of the promised sizes among which they begin with the best.
    pub parts: &'r [f64],
}

impl<'r> Task<'r> {
    /// Whether little more than noise is left.
    pub fn is_near(&self) -> bool {
        self.fit.train.pooled < thresholds::FAR
    }

    /// Whether candidates are seen over whole windows first.
    pub fn is_whole(&self) -> bool {
        self.is_near() || !self.setting.fits_starts()
    }

    /// Whether what was left is most of the way to what a right model would leave.
    pub fn explains_most(&self, fit: &Fit) -> bool {
        let little = (thresholds::CLOSE * self.floor).max(thresholds::MOST_OF * self.fit.left());
        leaves_less(fit, little)
    }

    /// Candidates to be fitted, begun as most are.
    pub fn round(
        self,
        candidates: &'r [Candidate],
        screen: &'r Screen,
        is_whole: bool,
    ) -> Round<'r> {
        Round {
            task: self,
            candidates,
            screen,
            is_whole,
            most: thresholds::MOST_SKETCHES,
            parts: &PARTS,
        }
    }
}

impl Round<'_> {
    /// The best candidates alone and those that look like them, of those from this one on.
    pub fn singles(&self, from: usize) -> Vec<Trial> {
        let mut ranked = self.ranked();
        ranked.retain(|response| self.screen.responses[*response].candidate >= from);
        if let Some(best) = ranked.first() {
            let (count, best) = (ranked.len(), self.candidate(*best).label());
            (self.task.said)(&format!("{count} promise enough to be fitted, {best} most"));
        }
        let mut sketches = self.sketched(self.chosen(&ranked));
        if !leaves_less(self.task.fit, thresholds::CLOSE * self.task.floor) {
            let most = thresholds::HELPS * self.screen.left(&[]).0;
            sketches.retain(|(_, sketch)| sketch.left < most);
        }
        let mut trials: Vec<Trial> = Vec::new();
        let (mut fits, mut best) = (0, f64::INFINITY);
        while !sketches.is_empty() && fits < thresholds::MOST_FITS {
            // Once one is believed, only what is nearly as good or looks like it may be another
            // answer; until then whoever is next.
            let believed = trials.iter().find(|trial| trial.verdict.is_ok());
            if believed.is_none() {
                best = sketches[0].1.left;
            }
            let count = sketches.len().min(thresholds::FITS_AT_ONCE);
            let next: Vec<(Set, Sketch)> = sketches.drain(..count).collect();
            let is_rival = |(set, sketch): &(Set, Sketch)| {
                let near = sketch.left < thresholds::RIVAL * best;
                match believed {
                    Some(trial) => {
                        let alike = self.screen.similarity(trial.responses[0], set.responses[0]);
                        alike > thresholds::ALIKE
                            || (near && !at_floor(&trial.fit, self.task.floor))
                    }
                    None => near,
                }
            };
            let wanted: Vec<(Set, Sketch)> = next.into_iter().filter(is_rival).collect();
            fits += wanted.len();
            trials.extend(self.completed(wanted));
        }
        self.reshape(&mut trials);
        trials
    }

    /// The candidates that look like one of them, as far as they promise enough, the most alike
    /// first; at most [`thresholds::MOST_FITS`].
    pub fn alike(&self, response: usize) -> Vec<Trial> {
        let similar = |other: &usize| self.screen.similarity(response, *other);
        let mut alike = self.ranked();
        alike.retain(|other| *other != response && similar(other) > thresholds::ALIKE);
        alike.sort_by(|a, b| similar(b).total_cmp(&similar(a)));
        alike.truncate(thresholds::MOST_FITS);
        self.completed(self.sketched(self.chosen(&alike)))
    }

    /// Those of the ranked that are begun: of what repeats with an angle, of which there is so
    /// much that some is lucky, half as many, and of the orders of one effect at one place the
    /// two best.
    fn chosen(&self, ranked: &[usize]) -> Vec<Set> {
        let (mut plain, mut repeating) = (Vec::new(), Vec::new());
        for response in ranked {
            let of = self.candidate(*response);
            let is_same = |known: &&usize| {
                let known = self.candidate(**known);
                known.effect == of.effect && known.on == of.on
            };
            if of.order.is_none() && plain.len() < self.most {
                plain.push(*response);
            } else if of.order.is_some()
                && repeating.len() < self.most.div_ceil(2)
                && repeating.iter().filter(is_same).count() < 2
            {
                repeating.push(*response);
            }
        }
        let both = plain.into_iter().chain(repeating);
        both.map(|response| Set {
            sizes: self.screen.responses[response].values.clone(),
            responses: vec![response],
            deleted: None,
        })
        .collect()
    }

    /// Candidates that promise enough, the best first.
    pub(crate) fn ranked(&self) -> Vec<usize> {
        let screen = self.screen;
        let alone = screen.left(&[]).0;
        let promise = match alone > thresholds::FAR * thresholds::FAR * screen.numbers {
            true => thresholds::PROMISE_FAR,
            false => thresholds::PROMISE,
        };
        let enough = |r: &usize| {
            let response = &screen.responses[*r];
            // What a nuisance gains without its prior, the others did not do within theirs.
            let is_own = response.released.is_some()
                || response.visible > thresholds::OWN_PART
                || response.gain > thresholds::ENOUGH * alone;
            is_own && response.gain > promise * alone
        };
        let mut ranked: Vec<usize> = (0..screen.responses.len()).filter(enough).collect();
        let gain = |r: &usize| screen.responses[*r].gain;
        ranked.sort_by(|a, b| gain(b).total_cmp(&gain(a)));
        ranked
    }

    pub(crate) fn candidate(&self, response: usize) -> &Candidate {
        &self.candidates[self.screen.responses[response].candidate]
    }

    /// The names of a set's candidates.
    fn label(&self, set: &Set) -> String {
        let labels = set.responses.iter().map(|r| self.candidate(*r).label());
        labels.collect::<Vec<_>>().join(" and ")
    }

    /// Sets of candidates begun, side by side; the best first.
    pub(crate) fn sketched(&self, sets: Vec<Set>) -> Vec<(Set, Sketch)> {
        let alone = self.screen.left(&[]).0;
        let sketches: Vec<Result<Sketch, String>> =
            sets.par_iter().map(|set| self.sketch(set)).collect();
        let mut found = Vec::new();
        for (set, sketch) in sets.into_iter().zip(sketches) {
            let label = self.label(&set);
            match sketch {
                Ok(sketch) => {
                    let part = 100.0 * sketch.left / alone;
                    let of = if self.is_whole {
                        "squares"
                    } else {
                        "beginnings of windows"
                    };
                    (self.task.said)(&format!("  {label}: {part:.1} % left of the {of}"));
                    found.push((set, sketch));
                }
                Err(error) => (self.task.said)(&format!("  {label}: {error}")),
            }
        }
        found.sort_by(|a, b| a.1.left.total_cmp(&b.1.left));
        found
    }

    /// Sketches fitted in earnest, side by side.
    pub(crate) fn completed(&self, sketches: Vec<(Set, Sketch)>) -> Vec<Trial> {
        let fits: Vec<(Set, Result<Fit, String>)> = sketches
            .into_par_iter()
            .map(|(set, sketch)| (set, self.task.setting.complete(sketch)))
            .collect();
        let mut trials = Vec::new();
        for (set, new) in fits {
            let label = self.label(&set);
            match new {
                Ok(new) => {
                    let own = self.own(&set);
                    let verdict = judge(self.task.fit, &new, &own);
                    let explains = explains(self.task.fit, &new, &own).is_ok();
                    let outcome = verdict.as_ref().err().map_or("believed", String::as_str);
                    let (train, test) = (new.train.pooled, new.test.pooled);
                    (self.task.said)(&format!(
                        "  {label}: {train:.2} noises are left in training, {test:.2} in test; {outcome}"
                    ));
                    trials.push(Trial {
                        responses: set.responses,
                        own,
                        fit: new,
                        verdict,
                        explains,
                    });
                }
                Err(error) => (self.task.said)(&format!("  {label}: {error}")),
            }
        }
        trials
    }
}

/// Whether a fit leaves no more than a right model would.
pub fn at_floor(fit: &Fit, floor: f64) -> bool {
    leaves_less(fit, thresholds::AT_FLOOR * floor)
}

/// Whether a fit leaves less than so many noises, on both sets of records.
pub fn leaves_less(fit: &Fit, noises: f64) -> bool {
    fit.train.pooled.max(fit.test.pooled) < noises
}
