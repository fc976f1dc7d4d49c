//! Others in the place of a round's answer: an effect on one shaft of a gear looks like the same
//! effect on the next, and which of them is fitted better may be chance of where it began. What may
//! be meant instead is fitted once more from where the answer ended.

use crate::catalogue::Effect;
use crate::catalogue::candidate::{Candidate, candidates};
use crate::catalogue::sites::sites;
use crate::fit::preliminary::Sketch;
use crate::search::fitted::{Round, Trial};
use crate::search::hypothesis::Set;
use crate::search::round::usual_rates;
use crate::search::screening::screen;
use crate::thresholds;

impl Round<'_> {
    /// Fits what may stand in the place of a trial from where that ended, and takes over what
    /// leaves less than it did before.
    pub fn swap(&self, trials: &mut Vec<Trial>, answer: usize, effects: &[Effect]) {
        let sketches = self
            .in_place_of(trials, answer, effects)
            .unwrap_or_default();
        for new in self.completed(sketches) {
            let known = trials
                .iter_mut()
                .find(|trial| trial.responses == new.responses);
            match known {
                Some(known) if new.fit.left() < known.fit.left() => *known = new,
                Some(_) => {}
                None => trials.push(new),
            }
        }
    }

    /// The best of those that may stand in the place of a trial, begun where that ended; none if
    /// it is not one effect with terms of its own.
    fn in_place_of(
        &self,
        trials: &[Trial],
        answer: usize,
        effects: &[Effect],
    ) -> Option<Vec<(Set, Sketch)>> {
        let trial = &trials[answer];
        let [response] = trial.responses[..] else {
            return None;
        };
        if self.screen.responses[response].released.is_some() {
            return None;
        }
        let rivals = self.rivals(trials, answer, response);
        let (rivals, there) = self.there(trial, &rivals, effects);
        if there.is_empty() {
            return None;
        }
        (self.task.said)(&format!(
            "screening {} in the place of {}",
            there.len(),
            self.candidate(response).label()
        ));
        let mut promised = self.promised(trial, &there)?;
        promised.sort_by(|a, b| a.1.total_cmp(&b.1));
        promised.truncate(thresholds::FITS_AT_ONCE);
        let shaped = self.shaped(trial).unwrap_or(1.0);
        let sketches = promised.into_iter().filter_map(|(place, left, sizes)| {
            let set = Set {
                responses: vec![rivals[place]],
                deleted: None,
                sizes,
            };
            let sketch = self.begun_at(&set, (trial, left), shaped).ok()?;
            Some((set, sketch))
        });
        Some(sketches.collect())
    }

    /// Those of the rivals that there are in a trial's model, as candidates for that: names that
    /// the trial took are not free there, and shapes go with the trial's.
    fn there(
        &self,
        trial: &Trial,
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
            &usual_rates(self.task.setting, model),
        );
        let shaped = self.shaped(trial).unwrap_or(1.0);
        let again = |rival: &usize| {
            let label = self.candidate(*rival).label();
            let found = known.iter().find(|candidate| candidate.label() == label)?;
            let mut found = found.clone();
            let shapes = found.parameters.iter_mut().map(|p| &mut p.shape);
            shapes.flatten().for_each(|shape| *shape *= shaped);
            Some((*rival, found))
        };
        rivals.iter().filter_map(again).unzip()
    }

    /// Which candidates promise to leave little without a trial's own terms, what they leave and
    /// their sizes.
    fn promised(&self, trial: &Trial, there: &[Candidate]) -> Option<Vec<(usize, f64, Vec<f64>)>> {
        let mut screen = screen(self.task.setting, &trial.fit, there, 1.0);
        let left = screen.left(&[]).0;
        let theta = &trial.fit.train.estimate.theta;
        for own in &trial.own {
            screen = match own.is_shape {
                true => screen.held(own.place),
                false => screen.without(own.place, theta[own.place])?,
            };
        }
        let promised = (0..screen.responses.len()).map(|place| {
            let (left, sizes) = screen.left(&[place]);
            (screen.responses[place].candidate, left, sizes)
        });
        Some(
            promised
                .filter(|(_, promised, _)| *promised < thresholds::RIVAL * left)
                .collect(),
        )
    }

    /// How a trial's shape ended, in what it began with: a speed that friction falls with is so
    /// many times the usual one wherever the friction sits.
    fn shaped(&self, trial: &Trial) -> Option<f64> {
        let shape = trial.own.iter().find(|own| own.is_shape)?;
        let began = self.screen.responses[trial.responses[0]]
            .trials
            .iter()
            .find(|trial| trial.is_shape)?;
        Some(trial.fit.train.estimate.theta[shape.place] / began.unknown.start)
    }

    /// The same effect elsewhere, and what the record hardly tells from it, unless it leaves as
    /// little already.
    fn rivals(&self, trials: &[Trial], answer: usize, response: usize) -> Vec<usize> {
        let named = self.candidate(response);
        let enough = (1.0 + thresholds::TOLD_APART) * trials[answer].fit.left();
        let is_rival = |place: &usize| {
            let of = self.candidate(*place);
            let done = trials
                .iter()
                .any(|trial| trial.responses == [*place] && trial.fit.left() < enough);
            let turns = |c: &Candidate| c.order.as_ref().map(|(_, order)| *order);
            let same = of.effect == named.effect && turns(of) == turns(named);
            let is_own = self.screen.responses[*place].released.is_none();
            let alike = || self.screen.similarity(*place, response) > thresholds::ALIKE;
            *place != response && is_own && !done && (same || alike())
        };
        (0..self.screen.responses.len()).filter(is_rival).collect()
    }
}
