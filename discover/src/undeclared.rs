//! Parameters of the model that nobody called uncertain: candidates for being off where nothing
//! else is believed, and beside what is believed where they look like it.

use crate::candidates::{self, Candidate};
use crate::fitting::{FIRST_PART, Fit, Setting};
use crate::named::Searched;
use crate::rule;
use crate::screen::screen;
use crate::trials::{PARTS, Round};
use crate::unknowns::{Unknown, What};

/// The parameters of a model that no unknown moves.
pub fn shifts(fit: &Fit) -> Vec<Candidate> {
    let is_known = |name: &str| {
        let of = |unknown: &Unknown| match &unknown.what {
            What::Parameter(known) | What::Inverse(known) => known == name,
            What::Gain(_) | What::Bias(_) | What::Delay(_) => false,
        };
        fit.unknowns.iter().any(of)
    };
    let parameters = fit.plant.model.parameters.iter();
    let free = parameters.filter(|parameter| !is_known(&parameter.name));
    free.filter_map(candidates::shift).collect()
}

/// Parameters that look like what was named, fitted in its place: those that are believed, and
/// the response of what was named, beside which they were screened. None where nothing looks like
/// it, and where what was named is such a parameter: it had all others beside it. `fit`: what was
/// fitted before anything was named.
pub fn beside(
    setting: &Setting<'_>,
    fit: &Fit,
    named: &Candidate,
    floor: f64,
    said: &(dyn Fn(&str) + Sync),
) -> Option<(Searched, usize)> {
    let shifts = shifts(fit);
    let is_named = |shift: &Candidate| (&shift.effect, &shift.on) == (&named.effect, &named.on);
    if shifts.is_empty() || shifts.iter().any(is_named) {
        return None;
    }
    said(&format!(
        "screening {} parameters of the model beside {}",
        shifts.len(),
        named.label()
    ));
    let is_whole = fit.train.pooled < rule::FAR || !setting.fits_starts();
    let part = if is_whole { 1.0 } else { FIRST_PART.0 };
    let candidates: Vec<Candidate> = std::iter::once(named.clone()).chain(shifts).collect();
    let screen = screen(setting, fit, &candidates, part);
    let own = screen.responses.iter().position(|r| r.candidate == 0)?;
    let round = Round {
        setting,
        fit,
        candidates: &candidates,
        screen: &screen,
        is_whole,
        most: rule::MOST_FITS,
        parts: &PARTS,
        floor,
        said,
    };
    let mut trials = round.alike(own);
    trials.retain(|trial| trial.verdict.is_ok());
    Some(((candidates, screen, trials), own))
}
