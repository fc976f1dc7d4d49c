//! Whether a record can be believed.

use std::path::Path;

use crate::dataset::Refusal;

/// Times are finite and ascend.
pub fn check_times(path: &Path, times: &[f64]) -> Result<(), Refusal> {
    // The first line holds the names.
    let line = |sample: usize| sample as u64 + 2;
    if let Some(sample) = times.iter().position(|t| !t.is_finite()) {
        return Err(Refusal::line(
            path,
            line(sample),
            "the time is missing; expected a number",
        ));
    }
    if let Some(sample) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
        return Err(Refusal::line(
            path,
            line(sample + 1),
            "the time does not increase; expected samples in order, each once",
        ));
    }
    if times.len() < 2 {
        return Err(Refusal::file(path, "holds fewer than two samples"));
    }
    Ok(())
}

/// The median of the steps between samples, s.
pub fn typical_step(times: &[f64]) -> f64 {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(0.0)
}
