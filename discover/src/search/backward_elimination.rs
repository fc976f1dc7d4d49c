//! What was believed, one effect less: a later effect may do what an earlier one was taken for.

use crate::fit::full::Fit;
use crate::model::problem::Setting;
use crate::search::found::{Accepted, Found};
use crate::thresholds;

/// Takes away effects without which the records are explained as well, the least needed first.
/// `said` is told which.
pub fn thin(setting: &Setting<'_>, found: &mut Found, said: &dyn Fn(&str)) {
    while found.accepted.len() > 1 {
        let best = found.best();
        let fits = (0..found.accepted.len()).filter_map(|place| {
            let fit = without(setting, found, place).ok()?;
            is_as_good(best, &fit).then_some((place, fit))
        });
        let least = fits.min_by(|a, b| a.1.train.pooled.total_cmp(&b.1.train.pooled));
        let Some((place, fit)) = least else {
            return;
        };
        let label = found.accepted[place].candidate.label();
        said(&format!("  {label} is needed no more"));
        renumber(&mut found.accepted, place);
        found.last = Some(fit);
    }
}

/// Whether a fit with less leaves no more than one with more, but for what is asked of an effect.
fn is_as_good(with: &Fit, without: &Fit) -> bool {
    let worse = |with: f64, without: f64| with < (1.0 - thresholds::HELD_OUT) * without;
    !worse(with.train.pooled, without.train.pooled) && !worse(with.test.pooled, without.test.pooled)
}

/// The fit with all effects but one, begun where the fit with it ended.
fn without(setting: &Setting<'_>, found: &Found, place: usize) -> Result<Fit, String> {
    let fit = found.best();
    let gone = &found.accepted[place];
    let mut texts = (found.null.text.clone(), found.null.linear.clone());
    for (other, effect) in found.accepted.iter().enumerate() {
        if other == place || effect.candidate.released.is_some() {
            continue;
        }
        let values = fit.stated(&effect.unknowns);
        texts = setting.with((&texts.0, &texts.1), &effect.candidate, &values)?;
    }
    let mut unknowns = fit.unknowns.clone();
    let mut theta = fit.train.estimate.theta.clone();
    if gone.candidate.released.is_some() {
        for at in &gone.unknowns {
            unknowns[*at].clone_from(&found.null.unknowns[*at]);
            theta[*at] = found.null.unknowns[*at].start;
        }
    } else {
        let is_kept = |at: &usize| !gone.unknowns.contains(at);
        let kept: Vec<usize> = (0..unknowns.len()).filter(is_kept).collect();
        unknowns = kept.iter().map(|at| unknowns[*at].clone()).collect();
        theta = kept.iter().map(|at| theta[*at]).collect();
    }
    let left = fit.train.estimate.cost;
    let sketch = setting.expected(texts, unknowns, theta, (fit, left))?;
    setting.complete(sketch)
}

/// Takes an effect off the list; the unknowns of those behind it move up.
fn renumber(accepted: &mut Vec<Accepted>, place: usize) {
    let gone = accepted.remove(place);
    if gone.candidate.released.is_some() {
        return;
    }
    for effect in accepted {
        for at in &mut effect.unknowns {
            *at -= gone.unknowns.iter().filter(|gone| *gone < at).count();
        }
    }
}
