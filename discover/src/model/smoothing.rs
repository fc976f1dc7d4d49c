//! Zero-phase smoothing: a Butterworth low-pass filter, run forwards and backwards.

use std::f64::consts::PI;

use crate::thresholds;

/// Smooths a column by a second-order Butterworth filter, run forwards and backwards. Missing
/// samples are interpolated first.
pub fn smooth_column(times: &[f64], column: &[f64]) -> Vec<f64> {
    let mut values = fill_missing(times, column);
    let padding = values
        .len()
        .saturating_sub(1)
        .min((3.0 / thresholds::SMOOTHING_CUT_OFF_FRACTION) as usize);
    let mut padded = reflect_ends(&values, padding);
    filter_low_pass(&mut padded);
    padded.reverse();
    filter_low_pass(&mut padded);
    padded.reverse();
    values.copy_from_slice(&padded[padding..padded.len() - padding]);
    values
}

/// Returns the slope of a smooth column by central differences.
pub fn differentiate_column(times: &[f64], values: &[f64]) -> Vec<f64> {
    let last = values.len() - 1;
    (0..values.len())
        .map(|sample| {
            let (a, b) = (sample.saturating_sub(1), (sample + 1).min(last));
            (values[b] - values[a]) / (times[b] - times[a])
        })
        .collect()
}

/// Replaces missing samples by linear interpolation.
pub fn fill_missing(times: &[f64], column: &[f64]) -> Vec<f64> {
    let mut values = column.to_vec();
    let known: Vec<usize> = (0..values.len())
        .filter(|i| values[*i].is_finite())
        .collect();
    let (Some(first), Some(last)) = (known.first(), known.last()) else {
        return vec![0.0; values.len()];
    };
    let ends = (values[*first], values[*last]);
    values[..*first].fill(ends.0);
    values[last + 1..].fill(ends.1);
    for pair in known.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        for sample in a + 1..b {
            let part = (times[sample] - times[a]) / (times[b] - times[a]);
            values[sample] = column[a] + part * (column[b] - column[a]);
        }
    }
    values
}

/// Returns the column extended at both ends by point reflection, so that the filter starts on a
/// smooth continuation.
fn reflect_ends(values: &[f64], padding: usize) -> Vec<f64> {
    let last = values.len() - 1;
    let before = (1..=padding).rev().map(|k| 2.0 * values[0] - values[k]);
    let after = (1..=padding).map(|k| 2.0 * values[last] - values[last - k]);
    before.chain(values.iter().copied()).chain(after).collect()
}

/// Applies a second-order Butterworth low-pass filter (bilinear transform), which starts in
/// equilibrium.
fn filter_low_pass(values: &mut [f64]) {
    let c = 1.0 / (PI * thresholds::SMOOTHING_CUT_OFF_FRACTION).tan();
    let a0 = 1.0 + 2f64.sqrt() * c + c * c;
    let (b0, a1, a2) = (
        1.0 / a0,
        2.0 * (1.0 - c * c) / a0,
        (1.0 - 2f64.sqrt() * c + c * c) / a0,
    );
    let first = values[0];
    let (mut x1, mut x2, mut y1, mut y2) = (first, first, first, first);
    for value in values {
        let x = *value;
        let y = b0 * (x + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
        (x2, x1, y2, y1) = (x1, x, y1, y);
        *value = y;
    }
}

#[cfg(test)]
mod tests {
    use super::{differentiate_column, smooth_column};

    #[test]
    fn slow_motion_passes_without_delay() {
        let times: Vec<f64> = (0..4000).map(|i| f64::from(i) * 1e-3).collect();
        let motion: Vec<f64> = times.iter().map(|t| (3.0 * t).sin()).collect();
        let smooth = smooth_column(&times, &motion);
        let slope = differentiate_column(&times, &smooth);
        for sample in 0..times.len() {
            assert!((smooth[sample] - motion[sample]).abs() < 1e-4);
        }
        for sample in 200..3800 {
            assert!((slope[sample] - 3.0 * (3.0 * times[sample]).cos()).abs() < 1e-3);
        }
    }

    #[test]
    fn missing_sample_is_interpolated() {
        let times = [0.0, 1.0, 2.0, 3.0];
        let values = super::fill_missing(&times, &[1.0, f64::NAN, f64::NAN, 4.0]);
        assert_eq!(values, [1.0, 2.0, 3.0, 4.0]);
    }
}
