//! Check for a common delay of all channels. A delay of the input is a more likely cause than equal
//! delays of all sensors.

use crate::fit::fit_result::Fit;
use crate::ids::UnknownId;
use crate::model::input_occurrences::find_only_input;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::{NormalPrior, Unknown, UnknownKind};
use crate::thresholds;

/// Returns a note if all channels have nearly the same delay, and each delay is an effect or at the
/// bound of its prior.
pub(crate) fn note_common_delay(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<String> {
    if fit
        .unknowns()
        .any(|(_, unknown)| unknown.kind == UnknownKind::InputDelay)
    {
        return None;
    }
    let input = &find_only_input(fit.model.specification())?.name;
    let delays = fit
        .unknowns()
        .filter(|(_, unknown)| matches!(unknown.kind, UnknownKind::Delay(_)));
    let delays: Vec<f64> = delays.filter_map(|of| find_delay(fit, of)).collect();
    let (least, most) = (delays.iter()).fold((f64::INFINITY, 0.0_f64), |(least, most), delay| {
        (least.min(*delay), most.max(*delay))
    });
    let is_alike =
        delays.len() == problem.noise.len() && least > thresholds::MIN_DELAY_RATIO * most;
    is_alike.then(|| {
        format!(
            "all channels have a delay of about {:.3} ms: a delayed input, for example behind a current loop or \
             a bus, has the same effect; declare its prior as `delay` in [inputs.{input}]",
            1e3 * most
        )
    })
}

/// Returns the delay of a channel, s, if it was found as an effect or is at the bound of its prior.
fn find_delay(fit: &Fit, (id, unknown): (UnknownId, &Unknown)) -> Option<f64> {
    let value = fit.train.estimate.theta[id];
    let reach = thresholds::BOUND_FRACTION * thresholds::MAX_PRIOR_DEVIATION;
    let is_beyond_prior = |prior: NormalPrior| value - prior.mean >= reach * prior.sd;
    (value > 0.0 && unknown.prior.is_none_or(is_beyond_prior)).then_some(value)
}
