//! Check for a lag of the drive that is equivalent to a lag of all sensors.

use crate::fit::fit_result::Fit;
use crate::model::input_occurrences::find_only_input;
use crate::search::search_result::AcceptedEffect;

/// Effect of a drive with a first-order lag.
const LAG: &str = "input_lag";

/// Returns a note if a lag of the only input was found in a linear model. The same low-pass filter
/// after the machine has the same transfer function.
pub(crate) fn note_common_lag(fit: &Fit, accepted: &[AcceptedEffect]) -> Option<String> {
    if !accepted.iter().any(|found| found.candidate.effect == LAG) || !fit.model.is_linear() {
        return None;
    }
    let input = &find_only_input(fit.model.specification())?.name;
    Some(format!(
        "the same low-pass in every sensor gives the same records as the lag of `{input}`, because the model is linear: \
         before a controller relies on it, measure the output of the drive, or the motion with a sensor of another kind"
    ))
}
