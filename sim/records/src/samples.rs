//! What one column of samples must be before anything is done with it.

use std::path::Path;

use crate::refusal::Refusal;

/// A record with fewer samples says nothing of a model.
pub const FEWEST_SAMPLES: usize = 50;

/// Fewer samples of inputs are no motion to be driven through.
pub const FEWEST_OF_INPUTS: usize = 2;

/// An input is held over what is missing of it, a motion goes on as a spline; more than this part is refused.
const MOST_HELD: f64 = 0.1;

/// So many of the usual steps without a sample are a lost stretch; fewer are jitter.
pub(crate) const LOST: f64 = 5.0;

/// Steps that differ from the usual one by more than this part of it are jitter.
pub(crate) const JITTER: f64 = 0.1;

/// Times are finite and ascend, and are `fewest` or more. `lines`: that of each sample.
///
/// # Errors
/// The first line where they do not.
pub fn check_times(
    path: &Path,
    times: &[f64],
    lines: &[u64],
    fewest: usize,
) -> Result<(), Refusal> {
    if let Some(sample) = times.iter().position(|t| !t.is_finite()) {
        return Err(Refusal::line(
            path,
            lines[sample],
            "the time is missing; expected a number",
        ));
    }
    if let Some(sample) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
        return Err(Refusal::line(
            path,
            lines[sample + 1],
            "the time does not increase; expected samples in order, each once",
        ));
    }
    if times.len() < fewest {
        return Err(Refusal::file(
            path,
            format!("holds {} samples; expected {fewest} or more", times.len()),
        ));
    }
    Ok(())
}

/// An input, or a motion that is given, is known nearly everywhere.
///
/// # Errors
/// One of which much is missing. `what` it is, for people.
pub fn check_known(path: &Path, what: &str, column: &[f64]) -> Result<(), Refusal> {
    let missing = column.iter().filter(|value| !value.is_finite()).count();
    if missing as f64 > MOST_HELD * column.len() as f64 {
        return Err(Refusal::file(
            path,
            format!(
                "{what}: {missing} of {} samples are missing; expected nearly all of them",
                column.len()
            ),
        ));
    }
    Ok(())
}

/// The median of the steps between samples, s.
pub fn typical_step(times: &[f64]) -> f64 {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(0.0)
}

/// From a column's smallest value to its largest.
pub(crate) fn span(column: &[f64]) -> f64 {
    let known = || column.iter().copied().filter(|v| v.is_finite());
    known().fold(f64::NEG_INFINITY, f64::max) - known().fold(f64::INFINITY, f64::min)
}
