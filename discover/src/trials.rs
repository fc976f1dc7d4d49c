//! Candidates, alone or in pairs, fitted in earnest: those that screening promises most of, as
//! far as they are worth it. Where they come from is [`crate::search`]'s, whether they are
//! believed [`crate::judge`]'s.

use rayon::prelude::*;

use crate::candidates::Candidate;
use crate::fitting::{Fit, Setting, Sketch};
use crate::judge::{Evidence, Own, is_held, judge};
use crate::rule;
use crate::screen::Screen;
use crate::unknowns::{Unknown, What};

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
}

/// Candidates to be fitted together, and a parameter whose term they replace.
#[derive(Clone)]
pub(crate) struct Set {
    /// The candidates' places among the screened.
    pub responses: Vec<usize>,
    /// The place of the parameter.
    pub deleted: Option<usize>,
    /// The candidates' promised sizes, in order.
    pub sizes: Vec<f64>,
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
        self.fit.train.pooled < rule::FAR
    }

    /// Whether candidates are seen over whole windows first.
    pub fn is_whole(&self) -> bool {
        self.is_near() || !self.setting.fits_starts()
    }

    /// Whether what was left is most of the way to what a right model would leave.
    pub fn explains_most(&self, fit: &Fit) -> bool {
        let little = (rule::CLOSE * self.floor).max(rule::MOST_OF * self.fit.left());
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
            most: rule::MOST_SKETCHES,
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
        if !leaves_less(self.task.fit, rule::CLOSE * self.task.floor) {
            let most = rule::HELPS * self.screen.left(&[]).0;
            sketches.retain(|(_, sketch)| sketch.left < most);
        }
        let mut trials: Vec<Trial> = Vec::new();
        let (mut fits, mut best) = (0, f64::INFINITY);
        while !sketches.is_empty() && fits < rule::MOST_FITS {
            // Once one is believed, only what is nearly as good or looks like it may be another
            // answer; until then whoever is next.
            let believed = trials.iter().find(|trial| trial.verdict.is_ok());
            if believed.is_none() {
                best = sketches[0].1.left;
            }
            let count = sketches.len().min(rule::FITS_AT_ONCE);
            let next: Vec<(Set, Sketch)> = sketches.drain(..count).collect();
            let is_rival = |(set, sketch): &(Set, Sketch)| {
                let near = sketch.left < rule::RIVAL * best;
                match believed {
                    Some(trial) => {
                        let alike = self.screen.similarity(trial.responses[0], set.responses[0]);
                        alike > rule::ALIKE || (near && !at_floor(&trial.fit, self.task.floor))
                    }
                    None => near,
                }
            };
            let wanted: Vec<(Set, Sketch)> = next.into_iter().filter(is_rival).collect();
            fits += wanted.len();
            trials.extend(self.completed(wanted));
        }
        trials
    }

    /// The candidates that look like one of them, as far as they promise enough, the most alike
    /// first; at most [`rule::MOST_FITS`].
    pub fn alike(&self, response: usize) -> Vec<Trial> {
        let similar = |other: &usize| self.screen.similarity(response, *other);
        let mut alike = self.ranked();
        alike.retain(|other| *other != response && similar(other) > rule::ALIKE);
        alike.sort_by(|a, b| similar(b).total_cmp(&similar(a)));
        alike.truncate(rule::MOST_FITS);
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
    fn ranked(&self) -> Vec<usize> {
        let screen = self.screen;
        let alone = screen.left(&[]).0;
        let promise = match alone > rule::FAR * rule::FAR * screen.numbers {
            true => rule::PROMISE_FAR,
            false => rule::PROMISE,
        };
        let enough = |r: &usize| {
            let response = &screen.responses[*r];
            // What a nuisance gains without its prior, the others did not do within theirs.
            let is_own = response.released.is_some() || response.visible > rule::OWN_PART;
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
                    });
                }
                Err(error) => (self.task.said)(&format!("  {label}: {error}")),
            }
        }
        trials
    }

    /// The unknowns of a set's effects in a fit with them.
    fn own(&self, set: &Set) -> Vec<Own> {
        let mut next = self.task.fit.unknowns.len();
        let mut own = Vec::new();
        for (effect, response) in set.responses.iter().enumerate() {
            let response = &self.screen.responses[*response];
            if let Some(place) = response.released
                && let Some((mean, sd)) = self.task.fit.unknowns[place].prior
            {
                own.push(Own {
                    place,
                    effect,
                    base: mean,
                    is_shape: false,
                    prior: Some(sd),
                });
            }
            for trial in &response.trials {
                own.push(Own {
                    place: next,
                    effect,
                    base: trial.base,
                    is_shape: trial.is_shape,
                    prior: None,
                });
                next += 1;
            }
        }
        own
    }

    /// Pairs, and pairs in place of a term of the model. `singles`: what was fitted alone.
    pub fn pairs(&self, singles: &[Trial]) -> Vec<Trial> {
        // A sensor that runs to the end of what is admitted stands in for something else.
        let ran_away = |trial: &&Trial| {
            let of = |own: &Own| own.prior.is_some() && is_held(&trial.fit, own);
            trial.own.iter().any(of)
        };
        let away = singles.iter().filter(ran_away);
        let away: Vec<usize> = away.flat_map(|trial| trial.responses.clone()).collect();
        let is_there = |response: &usize| !away.contains(response);
        let ranked: Vec<usize> = self.ranked().into_iter().filter(is_there).collect();
        let mut added = 0;
        let mut sketches = self.sketched(self.best_pairs(&ranked, &away));
        sketches.retain(|(set, _)| {
            added += usize::from(set.deleted.is_none());
            set.deleted.is_some() || added <= rule::FITS_AT_ONCE
        });
        let mut trials = self.completed(sketches);
        for trial in &mut trials {
            let mut own = trial.responses.iter();
            let repeats = own.any(|response| self.candidate(*response).order.is_some());
            if repeats && trial.verdict.is_ok() && !self.task.explains_most(&trial.fit) {
                trial.verdict = Err("beside another it leaves much, which may be luck".to_owned());
            }
        }
        trials
    }

    /// The pairs that promise to leave clearly less than the best single candidate, and for each term of
    /// the model that may go the pair that takes its place best. Of what repeats with an angle the
    /// best alone are paired, and with something else: of that there is so much that some of it is
    /// lucky.
    fn best_pairs(&self, ranked: &[usize], away: &[usize]) -> Vec<Set> {
        let screen = self.screen;
        let best = ranked.first().map_or(0.0, |r| screen.responses[*r].gain);
        let single = screen.left(&[]).0 - best;
        // What is nothing alone may be half of a pair: friction of two kinds in place of a third.
        let repeats = |r: &usize| self.candidate(*r).order.is_some();
        let repeating: Vec<usize> = (ranked.iter().copied().filter(repeats))
            .take(rule::MOST_FITS)
            .collect();
        let few: Vec<usize> = (0..screen.responses.len())
            .filter(|r| {
                let response = &screen.responses[*r];
                let is_one = !repeats(r) || repeating.contains(r);
                is_one && !away.contains(r) && response.visible > rule::OWN_PART
            })
            .collect();
        let apart = |a: usize, b: usize| !self.share_a_name(a, b) && !(repeats(&a) && repeats(&b));
        let best_of = |deleted: Option<usize>, screen: &Screen| {
            let mut found: Vec<(f64, Set)> = Vec::new();
            for (number, a) in few.iter().enumerate() {
                let others = few[number + 1..].iter();
                for b in others.filter(|b| apart(*a, **b)) {
                    let responses = vec![*a, *b];
                    let (left, sizes) = screen.left(&responses);
                    // What replaces a term is far from where it was linearised: it is not held
                    // to a promise.
                    let promising = deleted.is_some() || left < rule::PAIR_PROMISE * single;
                    if promising && sizes.iter().all(|v| *v != 0.0) {
                        let set = Set {
                            responses,
                            deleted,
                            sizes,
                        };
                        found.push((left, set));
                    }
                }
            }
            found.sort_by(|a, b| a.0.total_cmp(&b.0));
            let count = match deleted {
                Some(_) => 1,
                None => rule::MOST_SKETCHES,
            };
            found
                .into_iter()
                .take(count)
                .map(|(_, set)| set)
                .collect::<Vec<Set>>()
        };
        let mut sets = best_of(None, screen);
        for (place, unknown) in self.task.fit.unknowns.iter().enumerate() {
            let value = self.task.fit.train.estimate.theta[place];
            let near = unknown
                .prior
                .is_some_and(|(mean, sd)| mean.abs() < rule::PRIOR_REACH * sd);
            if matches!(unknown.what, What::Parameter(_))
                && near
                && let Some(screen) = screen.without(place, value)
            {
                sets.extend(best_of(Some(place), &screen));
            }
        }
        sets
    }

    /// Whether two candidates call a parameter alike: one effect at two places. Of these the next
    /// round may add the other.
    pub(crate) fn share_a_name(&self, a: usize, b: usize) -> bool {
        let (a, b) = (self.candidate(a), self.candidate(b));
        let has = |name: &str| b.parameters.iter().any(|other| other.name == name);
        a.parameters.iter().any(|parameter| has(&parameter.name))
    }

    /// A sketch with a set's candidates.
    fn sketch(&self, set: &Set) -> Result<Sketch, String> {
        let (setting, fit) = (self.task.setting, self.task.fit);
        let (unknowns, theta) = self.unknowns(set, self.parts[0]);
        let texts = self.texts(set, &unknowns, &theta)?;
        // What swings in coordinates of its own is far from the fit however little it does.
        let adds_states = set.responses.iter().any(|response| {
            let parameters = &self.candidate(*response).parameters;
            parameters.iter().any(|parameter| parameter.inverse)
        });
        if self.is_whole && set.deleted.is_none() && !adds_states {
            let left = self.screen.left(&set.responses).0;
            return setting.expected(texts, unknowns, theta, (fit, left));
        }
        let others = self.parts[1..]
            .iter()
            .map(|part| self.unknowns(set, *part).1);
        let begins: Vec<Vec<f64>> = std::iter::once(theta).chain(others).collect();
        let mut sketch = setting.sketch(texts, unknowns, &begins)?;
        if self.is_whole {
            // Beside others that are promised and not begun.
            sketch.left = self.screen.left(&set.responses).0;
        }
        Ok(sketch)
    }

    /// The specification's texts with a set's candidates, at these values of the unknowns.
    fn texts(
        &self,
        set: &Set,
        unknowns: &[Unknown],
        theta: &[f64],
    ) -> Result<(String, String), String> {
        let fit = self.task.fit;
        let mut texts = (fit.text.clone(), fit.linear.clone());
        let mut next = fit.unknowns.len();
        for response in &set.responses {
            let response = &self.screen.responses[*response];
            if response.released.is_some() {
                continue;
            }
            let own = next..next + response.trials.len();
            next = own.end;
            let values: Vec<f64> = own
                .map(|place| unknowns[place].what.stated(theta[place]))
                .collect();
            let candidate = &self.candidates[response.candidate];
            texts = self
                .task
                .setting
                .with((&texts.0, &texts.1), candidate, &values)?;
        }
        Ok(texts)
    }

    /// A set of one candidate, begun with the motions of a trial of another. `left`: what that
    /// promises to leave; `shaped`: how many times its usual size a shape is.
    pub(crate) fn begun_at(
        &self,
        set: &Set,
        (trial, left): (&Trial, f64),
        shaped: f64,
    ) -> Result<Sketch, String> {
        let (unknowns, mut theta) = self.unknowns(set, 1.0);
        let count = self.task.fit.unknowns.len();
        theta[..count].copy_from_slice(&trial.fit.train.estimate.theta[..count]);
        for own in self.own(set).iter().filter(|own| own.is_shape) {
            theta[own.place] = unknowns[own.place].admissible(shaped * theta[own.place]);
        }
        let texts = self.texts(set, &unknowns, &theta)?;
        self.task
            .setting
            .expected(texts, unknowns, theta, (&trial.fit, left))
    }

    /// The unknowns with a set's candidates and their values, so much of the promised sizes from
    /// absent.
    fn unknowns(&self, set: &Set, part: f64) -> (Vec<Unknown>, Vec<f64>) {
        let fit = self.task.fit;
        let mut unknowns = fit.unknowns.clone();
        let mut theta = fit.anew();
        if let Some(place) = set.deleted {
            unknowns[place].bounds = (0.0, 0.0);
            theta[place] = 0.0;
        }
        let mut sizes = set.sizes.iter().map(|size| part * size);
        for response in &set.responses {
            let response = &self.screen.responses[*response];
            if let Some(place) = response.released {
                let size = sizes.next().unwrap_or(0.0);
                unknowns[place] = unknowns[place].released();
                theta[place] = unknowns[place].admissible(fit.train.estimate.theta[place] + size);
                continue;
            }
            for trial in &response.trials {
                let size = match trial.is_shape {
                    true => trial.unknown.start - trial.base,
                    false => sizes.next().unwrap_or(0.0),
                };
                let size = if size == 0.0 {
                    part * trial.unknown.scale
                } else {
                    size
                };
                theta.push(trial.unknown.admissible(trial.base + size));
                let mut unknown = trial.unknown.clone();
                unknown.scale = size.abs().max(1e-3 * unknown.scale);
                unknowns.push(unknown);
            }
        }
        (unknowns, theta)
    }
}

/// Whether a fit leaves no more than a right model would.
pub fn at_floor(fit: &Fit, floor: f64) -> bool {
    leaves_less(fit, rule::AT_FLOOR * floor)
}

/// Whether a fit leaves less than so many noises, on both sets of records.
pub fn leaves_less(fit: &Fit, noises: f64) -> bool {
    fit.train.pooled.max(fit.test.pooled) < noises
}
