//! Parameters of the model that nobody called uncertain: candidates for being off where nothing
//! else is believed, and beside what is believed where they look like it.

use crate::catalogue::candidate::{self, Candidate};
use crate::fit::full::Fit;
use crate::model::problem::FIRST_PART;
use crate::model::unknowns::{Unknown, What};
use crate::search::fitted::Task;
use crate::search::screening::screen;
use crate::search::selected::Searched;

/// The parameters of a model that no unknown moves.
pub fn shifts(fit: &Fit) -> Vec<Candidate> {
    let is_known = |name: &str| {
        let of = |unknown: &Unknown| match &unknown.what {
            What::Parameter(known) | What::Inverse(known) => known == name,
            What::Gain(_) | What::Bias(_) | What::Delay(_) => false,
        };
        fit.unknowns.iter().any(of)
    };
    let parameters = fit.plant.model().parameters.iter();
    let free = parameters.filter(|parameter| !is_known(&parameter.name));
    free.filter_map(candidate::shift).collect()
}

/// Parameters that look like what was named, fitted in its place: those that explain the records, and
/// the response of what was named, beside which they were screened. None where nothing looks like
/// it, and where what was named is such a parameter: it had all others beside it. The task's fit is
/// what was fitted before anything was named.
pub fn beside(task: Task<'_>, named: &Candidate) -> Option<(Searched, usize)> {
    let shifts = shifts(task.fit);
    let is_named = |shift: &Candidate| (&shift.effect, &shift.on) == (&named.effect, &named.on);
    if shifts.is_empty() || shifts.iter().any(is_named) {
        return None;
    }
    (task.said)(&format!(
        "screening {} parameters of the model beside {}",
        shifts.len(),
        named.label()
    ));
    let is_whole = task.is_whole();
    let part = if is_whole { 1.0 } else { FIRST_PART.0 };
    let candidates: Vec<Candidate> = std::iter::once(named.clone()).chain(shifts).collect();
    let screen = screen(task.setting, task.fit, &candidates, part);
    let own = screen.responses.iter().position(|r| r.candidate == 0)?;
    let mut trials = task.round(&candidates, &screen, is_whole).alike(own);
    trials.retain(|trial| trial.explains);
    Some(((candidates, screen, trials), own))
}
