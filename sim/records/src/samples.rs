//! Checks of single columns.

use std::path::Path;

use crate::refusal::Refusal;

/// Minimum number of samples of a record.
pub const MIN_SAMPLES: usize = 50;

/// Minimum number of samples of inputs for a simulation.
pub const MIN_INPUT_SAMPLES: usize = 2;

/// Maximum fraction of missing samples of a held input or an interpolated given motion.
const MAX_HELD_FRACTION: f64 = 0.1;

/// Time step, relative to the typical one, above which there is a gap. Smaller deviations are jitter.
pub(crate) const MIN_GAP_STEPS: f64 = 5.0;

/// Relative deviation of a time step from the typical one that counts as jitter.
pub(crate) const MAX_JITTER_FRACTION: f64 = 0.1;

/// Resolution of times in messages: one second divided by this number.
const SHOWN_PARTS: f64 = 1e9;

/// Checks that there are at least `fewest` finite, increasing times; `lines` are their line numbers.
pub fn check_times(
    path: &Path,
    times: &[f64],
    lines: &[u64],
    fewest: usize,
) -> Result<(), Refusal> {
    if let Some(sample) = times.iter().position(|t| !t.is_finite()) {
        return Err(Refusal::line_error(
            path,
            lines[sample],
            "the time is missing; expected a number",
        ));
    }
    if let Some(sample) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
        return Err(Refusal::line_error(
            path,
            lines[sample + 1],
            "the time does not increase; expected samples in order, each once",
        ));
    }
    if times.len() < fewest {
        return Err(Refusal::file_error(
            path,
            format!("has {} samples; expected {fewest} or more", times.len()),
        ));
    }
    Ok(())
}

/// Checks that few samples are missing in an input or in given motion, which the message calls `what`.
pub fn check_known(path: &Path, what: &str, column: &[f64]) -> Result<(), Refusal> {
    let missing = column.iter().filter(|value| !value.is_finite()).count();
    if missing as f64 > MAX_HELD_FRACTION * column.len() as f64 {
        return Err(Refusal::file_error(
            path,
            format!(
                "{what}: {missing} of {} samples are missing; expected at most a tenth of them",
                column.len()
            ),
        ));
    }
    Ok(())
}

/// Returns the typical time step, in s: the mean of the steps that differ from their median only by jitter. If times
/// have few digits, the median itself would be one of two rounded steps.
pub fn typical_step(times: &[f64]) -> f64 {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    let Some(median) = steps.get(steps.len() / 2).copied() else {
        return 0.0;
    };
    let is_usual = |step: &&f64| (*step - median).abs() <= MAX_JITTER_FRACTION * median;
    let (sum, count) =
        (steps.iter().filter(is_usual)).fold((0.0, 0.0), |(s, n), step| (s + step, n + 1.0));
    if count > 0.0 { sum / count } else { median }
}

/// Returns the time `origin + time` of a file, in s, without the rounding error of the sum.
pub fn round_file_time(origin: f64, time: f64) -> f64 {
    let shown = ((origin + time) * SHOWN_PARTS).round() / SHOWN_PARTS;
    if shown.is_finite() {
        shown
    } else {
        origin + time
    }
}

pub(crate) fn span(column: &[f64]) -> f64 {
    let known = || column.iter().copied().filter(|v| v.is_finite());
    known().fold(f64::NEG_INFINITY, f64::max) - known().fold(f64::INFINITY, f64::min)
}
