//! Pairs of candidates: those that promise clearly more than one alone, and others in the place of
//! one of a pair's two effects.

use crate::model::unknowns::What;
use crate::search::acceptance::{Own, is_held};
use crate::search::fitted::{Round, Trial};
use crate::search::hypothesis::Set;
use crate::search::screening::Screen;
use crate::thresholds;

impl Round<'_> {
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
            set.deleted.is_some() || added <= thresholds::FITS_AT_ONCE
        });
        let mut trials = self.completed(sketches);
        for trial in &mut trials {
            let mut own = trial.responses.iter();
            let repeats = own.any(|response| self.candidate(*response).order.is_some());
            if repeats && trial.verdict.is_ok() && !self.task.explains_most(&trial.fit) {
                trial.verdict = Err("beside another it leaves much, which may be luck".to_owned());
                trial.explains = false;
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
            .take(thresholds::MOST_FITS)
            .collect();
        let few: Vec<usize> = (0..screen.responses.len())
            .filter(|r| {
                let response = &screen.responses[*r];
                let is_one = !repeats(r) || repeating.contains(r);
                is_one && !away.contains(r) && response.visible > thresholds::OWN_PART
            })
            .collect();
        let never = |a: usize, b: usize| self.share_a_name(a, b) || (repeats(&a) && repeats(&b));
        let best_of = |deleted: Option<usize>, screen: &Screen| {
            let mut found: Vec<(f64, Set)> = Vec::new();
            for (number, a) in few.iter().enumerate() {
                let others = few[number + 1..].iter();
                for b in others.filter(|b| !never(*a, **b)) {
                    let responses = vec![*a, *b];
                    let (left, sizes) = screen.left(&responses);
                    // What replaces a term is far from where it was linearised: it is not held
                    // to a promise.
                    let promising = deleted.is_some() || left < thresholds::PAIR_PROMISE * single;
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
                None => thresholds::MOST_SKETCHES,
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
                .is_some_and(|(mean, sd)| mean.abs() < thresholds::PRIOR_REACH * sd);
            if matches!(unknown.what, What::Parameter(_))
                && near
                && let Some(screen) = screen.without(place, value)
            {
                sets.extend(best_of(Some(place), &screen));
            }
        }
        sets
    }

    /// Pairs that share one half with a pair and whose other half looks like its other, if they
    /// were not fitted yet; the most alike first, at most [`thresholds::FITS_AT_ONCE`].
    pub fn other_halves(&self, trials: &[Trial], pair: usize) -> Vec<Trial> {
        let [a, b] = trials[pair].responses[..] else {
            return Vec::new();
        };
        let mut found: Vec<(f64, Vec<usize>)> = Vec::new();
        for (kept, other) in [(a, b), (b, a)] {
            for response in 0..self.screen.responses.len() {
                let is_new = ![kept, other].contains(&response)
                    && !self.share_a_name(kept, response)
                    && self.candidate(response).order.is_none();
                let is_seen = self.screen.responses[response].visible > thresholds::OWN_PART;
                let similarity = match is_new && is_seen {
                    true => self.screen.similarity(other, response),
                    false => 0.0,
                };
                let pair = vec![kept, response];
                let is_known = |trial: &Trial| {
                    trial.responses.len() == 2 && pair.iter().all(|r| trial.responses.contains(r))
                };
                if similarity > thresholds::ALIKE && !trials.iter().any(is_known) {
                    found.push((similarity, pair));
                }
            }
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.truncate(thresholds::FITS_AT_ONCE);
        let set = |(_, responses): (f64, Vec<usize>)| Set {
            sizes: self.screen.left(&responses).1,
            responses,
            deleted: None,
        };
        self.completed(self.sketched(found.into_iter().map(set).collect()))
    }

    /// Whether two candidates call a parameter alike: one effect at two places. Of these the next
    /// round may add the other.
    pub(crate) fn share_a_name(&self, a: usize, b: usize) -> bool {
        let (a, b) = (self.candidate(a), self.candidate(b));
        let has = |name: &str| b.parameters.iter().any(|other| other.name == name);
        a.parameters.iter().any(|parameter| has(&parameter.name))
    }
}
