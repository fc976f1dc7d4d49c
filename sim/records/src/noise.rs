//! Noise of a column, estimated from differences between samples.

use crate::unwrapping::median;

/// Orders of the differences. At high orders slow motion vanishes and noise remains.
const DIFFERENCE_ORDERS: std::ops::RangeInclusive<usize> = 2..=8;

/// Median absolute value of a normal distribution, in standard deviations.
const NORMAL_MEDIAN: f64 = 0.674_489_750_196_081_7;

/// Returns the standard deviation of the white noise of an evenly sampled column, at least that of
/// its resolution; `None` for a constant column. Differences of order n of white noise have the
/// variance binomial(2n, n). The smallest estimate of all orders applies, because motion only
/// increases it.
pub fn estimate_noise(column: &[f64]) -> Option<f64> {
    let mut differences: Vec<f64> = column.to_vec();
    let mut least = f64::INFINITY;
    let mut variance = 1.0;
    for order in 1..=*DIFFERENCE_ORDERS.end() {
        differences = differences
            .windows(2)
            .map(|pair| pair[1] - pair[0])
            .collect();
        // Recurrence of binomial(2n, n).
        let n = order as f64;
        variance *= 2.0 * (2.0 * n - 1.0) / n;
        if DIFFERENCE_ORDERS.contains(&order)
            && let Some(noise) = noise_of_differences(&differences, variance)
        {
            least = least.min(noise);
        }
    }
    let found = least.max(resolution(column)? / f64::sqrt(12.0));
    (found > 0.0 && found.is_finite()).then_some(found)
}

/// Returns the standard deviation of white noise, robust against outliers, from differences that have this variance at a
/// standard deviation of 1; `None` without known differences.
pub(crate) fn noise_of_differences(differences: &[f64], variance: f64) -> Option<f64> {
    let known = differences
        .iter()
        .map(|d| d.abs())
        .filter(|d| d.is_finite());
    let median = median(&known.collect::<Vec<f64>>())?;
    Some(median / NORMAL_MEDIAN / variance.sqrt())
}

fn resolution(column: &[f64]) -> Option<f64> {
    let mut values: Vec<f64> = column.iter().copied().filter(|v| v.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let largest = values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    // Steps in the last digits of a double are rounding.
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let steps = steps.filter(|step| *step > 1e-12 * largest);
    steps.min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::estimate_noise;

    /// Returns nearly normal numbers with mean 0 and standard deviation 1.
    fn normal(count: usize) -> Vec<f64> {
        let mut state = 7u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..count)
            .map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0)
            .collect()
    }

    #[test]
    fn noise_ignores_motion_and_is_at_least_resolution() {
        let motion = |k: usize| 0.3 * (0.02 * k as f64).sin() + 0.05 * (0.21 * k as f64).cos();
        let noisy = |sd: f64| -> Vec<f64> {
            let noise = normal(4000).into_iter().enumerate();
            noise.map(|(k, n)| motion(k) + sd * n).collect()
        };
        for sd in [1e-5, 1e-3, 0.1] {
            let found = estimate_noise(&noisy(sd)).expect("noise");
            assert!((found / sd - 1.0).abs() < 0.1, "{sd}: {found}");
        }
        let step = 2.0 * std::f64::consts::PI / 4096.0;
        let rounded: Vec<f64> = (0..4000)
            .map(|k| (motion(k) / step).round() * step)
            .collect();
        let found = estimate_noise(&rounded).expect("noise");
        assert!(found > 0.9 * step / 12f64.sqrt() && found < step, "{found}");
        assert_eq!(estimate_noise(&[1.0; 100]), None);
    }
}
