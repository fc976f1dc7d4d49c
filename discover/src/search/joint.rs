//! Two effects of which neither is believed alone, and which no pair promised: the best single one,
//! and what is believed beside it.

use crate::search::acceptance::{Own, is_held, judge};
use crate::search::fitted::{Task, Trial};
use crate::search::round::{Look, View};
use crate::search::selected::{Named, Searched, leaves_clearly_less, named};

impl Look<'_> {
    /// What is believed together of what was looked at, if it explains most of what is left.
    pub(crate) fn together(&self, searched: &[Searched]) -> Option<Named> {
        let all = searched.iter().flat_map(|(candidates, screen, trials)| {
            let with = move |trial| (candidates, screen, trial);
            trials.iter().map(with)
        });
        let promising = all.filter(|(_, _, trial)| self.is_promising(trial));
        let (candidates, screen, first) =
            promising.min_by(|a, b| a.2.fit.left().total_cmp(&b.2.fit.left()))?;
        let candidate = candidates[screen.responses[first.responses[0]].candidate].clone();
        (self.task.said)(&format!("looking at what is beside {}", candidate.label()));
        let beside = Look {
            task: Task {
                fit: &first.fit,
                ..self.task
            },
            is_first: false,
            effects: self.effects,
        };
        let (candidates, screen, mut trials) = beside.looked(View::Whole)?;
        trials.retain(|trial| trial.explains);
        let mut found = named(beside.task, (candidates, screen, trials))?;
        let second = found.trial.own.into_iter().map(|own| Own {
            effect: own.effect + 1,
            ..own
        });
        found.trial.own = first.own.iter().cloned().chain(second).collect();
        found.trial.verdict = judge(self.task.fit, &found.trial.fit, &found.trial.own);
        let is_believed = found.trial.verdict.is_ok() && self.task.explains_most(&found.trial.fit);
        found.candidates.insert(0, candidate);
        found.equivalent.insert(0, Vec::new());
        is_believed.then_some(found)
    }

    /// Whether a single effect leaves clearly less though it is not believed, and was not held.
    fn is_promising(&self, trial: &Trial) -> bool {
        let is_free = |own: &Own| own.prior.is_none() && !is_held(&trial.fit, own);
        trial.responses.len() == 1
            && trial.own.iter().all(is_free)
            && leaves_clearly_less(&trial.fit, self.task.fit)
    }
}
