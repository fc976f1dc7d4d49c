//! Check for delays of all channels that compensate for held inputs.

use eomgen_records::samples::typical_step;

use crate::fit::fit_result::Fit;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::UnknownKind;
use crate::thresholds;

/// Returns a note if all channels lead by about half the interval of inputs that change at most samples. A
/// held value is on average half an interval older than the smooth input that the machine receives.
pub(crate) fn note_held_input(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<String> {
    let record = problem.dataset.train.first()?;
    let interval = typical_step(&record.times);
    let delays = fit
        .unknowns()
        .filter(|(_, unknown)| matches!(unknown.kind, UnknownKind::Delay(_)))
        .map(|(id, _)| fit.train.estimate.theta[id]);
    let delays: Vec<f64> = delays.collect();
    let mean = delays.iter().sum::<f64>() / delays.len() as f64;
    let is_half =
        (delays.iter()).all(|delay| thresholds::HALF_INTERVAL_LEAD.contains(&(-delay / interval)));
    let is_smooth = !record.input_columns.is_empty()
        && record
            .input_columns
            .iter()
            .all(|column| changing_fraction(column) > thresholds::MIN_CHANGING_FRACTION);
    (delays.len() == problem.noise.len() && is_half && is_smooth).then(|| {
        format!(
            "all channels lead by about {:.2} ms, half the interval of {:.2} ms between the samples: recorded inputs \
             are held until the next sample and are then half an interval late on average if the input of the \
             machine changes continuously. These negative delays describe the held inputs, not the sensors; record \
             the inputs more often to reduce them",
            -1e3 * mean,
            1e3 * interval
        )
    })
}

/// Returns the fraction of the samples that differ from the one before.
fn changing_fraction(column: &[f64]) -> f64 {
    let changes = column.windows(2).filter(|pair| pair[0] != pair[1]);
    changes.count() as f64 / column.len().saturating_sub(1).max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::changing_fraction;

    #[test]
    fn steps_change_at_few_samples() {
        assert_eq!(changing_fraction(&[0.0, 0.0, 1.0, 1.0, 1.0]), 0.25);
        assert_eq!(changing_fraction(&[0.0, 1.0, 2.0]), 1.0);
        assert_eq!(changing_fraction(&[]), 0.0);
    }
}
