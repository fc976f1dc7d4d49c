//! Check for delays of all channels that compensate for held inputs.

use eomgen_records::samples::typical_step;

use crate::fit::fit_result::Fit;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::UnknownKind;
use crate::thresholds;

/// Returns a note if all channels lead significantly by about half a sample interval, and an input
/// changes at most samples. A held value is on average half an interval older than the smooth input
/// of the machine.
pub(crate) fn note_held_input(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<String> {
    let record = problem.dataset.train.first()?;
    let interval = typical_step(&record.times);
    let delays = fit
        .unknowns()
        .filter(|(_, unknown)| matches!(unknown.kind, UnknownKind::Delay(_)))
        .map(|(id, _)| (fit.train.estimate.theta[id], fit.sd[id]));
    let delays: Vec<(f64, f64)> = delays.collect();
    let mean = delays.iter().map(|(delay, _)| delay).sum::<f64>() / delays.len() as f64;
    let is_half = (delays.iter()).all(|(delay, sd)| is_half_interval_lead(*delay, *sd, interval));
    let is_smooth = !record.input_columns.is_empty()
        && record
            .input_columns
            .iter()
            .all(|column| compute_changing_fraction(column) > thresholds::MIN_CHANGING_FRACTION);
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

/// Returns true if a delay is a lead of about half an interval and differs from 0 significantly.
fn is_half_interval_lead(delay: f64, sd: f64, interval: f64) -> bool {
    thresholds::HALF_INTERVAL_LEAD.contains(&(-delay / interval))
        && -delay > thresholds::MIN_LEAD_DEVIATIONS * sd
}

/// Returns the fraction of the samples that differ from the preceding sample.
fn compute_changing_fraction(column: &[f64]) -> f64 {
    let changes = column.windows(2).filter(|pair| pair[0] != pair[1]);
    changes.count() as f64 / column.len().saturating_sub(1).max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::{compute_changing_fraction, is_half_interval_lead};

    #[test]
    fn lead_below_three_standard_deviations_is_not_significant() {
        assert!(is_half_interval_lead(-2.5e-3, 0.8e-3, 5e-3));
        assert!(!is_half_interval_lead(-2.5e-3, 0.9e-3, 5e-3));
        assert!(!is_half_interval_lead(2.5e-3, 0.1e-3, 5e-3));
        assert!(!is_half_interval_lead(-0.5e-3, 0.1e-3, 5e-3));
    }

    #[test]
    fn steps_change_at_few_samples() {
        assert_eq!(compute_changing_fraction(&[0.0, 0.0, 1.0, 1.0, 1.0]), 0.25);
        assert_eq!(compute_changing_fraction(&[0.0, 1.0, 2.0]), 1.0);
        assert_eq!(compute_changing_fraction(&[]), 0.0);
    }
}
