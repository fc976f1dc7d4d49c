//! Single wrong samples of a smooth quantity, such as a dropout of a sensor or of its transmission.
//!
//! A wrong sample changes the fourth differences by its error times 1, -4, 6, -4, 1. The fourth differences of a smooth
//! motion with a step or a kink have other patterns (F. B. Hildebrand, *Introduction to Numerical Analysis*, 4.9).

use crate::noise::estimate_noise_of_differences;
use crate::samples::{MAX_JITTER_FRACTION, typical_step};

/// Fourth differences of an error of 1 in one sample.
const PATTERN: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];

/// Sum of the squares of [`PATTERN`], the variance of fourth differences of white noise.
const PATTERN_SQUARE: f64 = 70.0;

/// Smallest error of a wrong sample, relative to the noise. White noise reaches 7 in 1e12 samples.
const MIN_ERROR_OVER_NOISE: f64 = 30.0;

/// Largest remainder of the fourth differences after subtraction of the pattern, relative to the error. For a step the
/// remainder is 2.
const MAX_REST_FRACTION: f64 = 0.2;

/// Wrong sample of a column.
pub(crate) struct Outlier {
    pub sample: usize,
    /// Difference from the value interpolated from neighbouring samples.
    pub error: f64,
}

/// Returns the wrong samples of a column in order. `noise` is its standard deviation. Samples next to uneven steps,
/// missing samples or other wrong samples are not examined.
pub(crate) fn find_outliers(times: &[f64], column: &[f64], noise: f64) -> Vec<Outlier> {
    let step = typical_step(times);
    let is_even = |part: &[f64]| {
        let mut steps = part.windows(2).map(|pair| pair[1] - pair[0]);
        steps.all(|own| (own - step).abs() <= MAX_JITTER_FRACTION * step)
    };
    let differences: Vec<f64> = column
        .windows(5)
        .map(|part| {
            part.iter()
                .zip(PATTERN)
                .map(|(own, factor)| own * factor)
                .sum()
        })
        .collect();
    let Some(own_noise) = estimate_noise_of_differences(&differences, PATTERN_SQUARE) else {
        return Vec::new();
    };
    let least = MIN_ERROR_OVER_NOISE * noise.max(own_noise);
    let outlier = |(first, part): (usize, &[f64])| {
        let pairs = || part.iter().zip(PATTERN);
        let error = pairs().map(|(own, factor)| own * factor).sum::<f64>() / PATTERN_SQUARE;
        let rests = pairs().map(|(own, factor)| (own - error * factor).abs());
        let rest = rests.fold(0.0, f64::max);
        let sample = first + PATTERN.len() - 1;
        let is_wrong = error.abs() > least
            && rest <= MAX_REST_FRACTION * error.abs()
            && is_even(&times[first..=sample + PATTERN.len() - 1]);
        is_wrong.then_some(Outlier { sample, error })
    };
    differences
        .windows(5)
        .enumerate()
        .filter_map(outlier)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a deterministic number between -1 and 1.
    fn random(place: usize) -> f64 {
        let mixed = (place as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn times(count: usize) -> Vec<f64> {
        (0..count).map(|sample| 1e-3 * sample as f64).collect()
    }

    #[test]
    fn wrong_samples_are_found_with_their_error() {
        let times = times(1000);
        for error in [0.01, -0.5, 1e4] {
            let mut column: Vec<f64> = times
                .iter()
                .enumerate()
                .map(|(sample, t)| (20.0 * t).sin() + 1e-5 * random(sample))
                .collect();
            for sample in [5, 400, 405, 994] {
                column[sample] += error;
            }
            let found = find_outliers(&times, &column, 1e-5);
            let samples: Vec<usize> = found.iter().map(|own| own.sample).collect();
            assert_eq!(samples, [5, 400, 405, 994], "{error}");
            assert!(
                found
                    .iter()
                    .all(|own| (own.error / error - 1.0).abs() < 0.05)
            );
        }
    }

    #[test]
    fn steps_kinks_bursts_and_fast_oscillations_are_no_outliers() {
        let times = times(2000);
        for case in 0..400 {
            let (place, size) = (300 + case, 10.0_f64.powi(case as i32 % 5 - 3));
            let pulse = move |sample: usize| -> f64 {
                let after = sample as f64 - place as f64;
                let is_after = sample >= place;
                match case % 5 {
                    0 => f64::from(is_after),
                    1 => f64::from(is_after) * after,
                    2 => f64::from((place..place + 2).contains(&sample)),
                    3 => f64::from(is_after) * (1e-2 * (1 + case) as f64 * after).sin(),
                    _ => f64::from(is_after) * (-0.5 * after).exp(),
                }
            };
            let column: Vec<f64> = (0..times.len())
                .map(|sample| size * pulse(sample) + 1e-5 * random(sample + 7 * case))
                .collect();
            let found = find_outliers(&times, &column, 1e-5);
            assert!(found.is_empty(), "case {case}: sample {}", found[0].sample);
        }
    }
}
