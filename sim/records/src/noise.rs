//! Noise of a column, estimated from differences between samples.

use crate::unwrapping::median;

/// Orders of the differences. In differences of high order the slow motion vanishes and the noise remains.
const DIFFERENCE_ORDERS: std::ops::RangeInclusive<usize> = 2..=8;

/// Median absolute value of a normal distribution with the standard deviation 1.
const NORMAL_MEDIAN: f64 = 0.674_489_750_196_081_7;

/// Differences beyond this multiple of the standard deviation are outliers.
const MAX_DIFFERENCE_OVER_NOISE: f64 = 4.0;

/// An estimate that exceeds that of a higher order by more than this multiple of its standard deviation is attributed
/// to motion. For 1600 random motions with 200 to 8000 samples, the factor 2 gives a mean error of +0.4 to +2.3 %, and
/// 3 gives +0.6 to +3.1 %. The smallest estimate of all orders is 15 % low for one of twenty motions with 500 samples.
const MAX_EXCESS_OVER_ERROR: f64 = 2.0;

/// Noise estimate from differences of one order.
struct OrderEstimate {
    /// Standard deviation of the noise.
    noise: f64,
    /// Standard deviation of the estimate, relative to the estimate.
    relative_error: f64,
}

/// Returns the standard deviation of the white noise of an evenly sampled column, at least that of its resolution;
/// `None` for a constant column. Differences of order n of white noise have the variance binomial(2n, n). The result is
/// the estimate of the lowest order that no higher order contradicts (O. V. Lepskii, *Theory of Probability and its
/// Applications* 35, 1990). Motion increases the estimates of low orders, and estimates of high orders have a larger
/// variance.
pub fn estimate_noise(column: &[f64]) -> Option<f64> {
    let mut differences: Vec<f64> = column.to_vec();
    let mut estimates: Vec<OrderEstimate> = Vec::new();
    for order in 1..=*DIFFERENCE_ORDERS.end() {
        differences = differences
            .windows(2)
            .map(|pair| pair[1] - pair[0])
            .collect();
        if DIFFERENCE_ORDERS.contains(&order) {
            estimates.extend(estimate_of_order(&differences, order));
        }
    }
    let agrees = |place: usize| {
        let own = estimates[place].noise;
        let mut higher = estimates[place + 1..].iter();
        higher
            .all(|other| own <= other.noise * (1.0 + MAX_EXCESS_OVER_ERROR * other.relative_error))
    };
    let lowest = (0..estimates.len()).find(|place| agrees(*place));
    let noise = lowest.map_or(0.0, |place| estimates[place].noise);
    let found = noise.max(estimate_resolution(column)? / f64::sqrt(12.0));
    (found > 0.0 && found.is_finite()).then_some(found)
}

/// Estimates the noise by the root mean square of the differences without outliers. The correlation of two differences
/// k samples apart is binomial(2n, n + k)/binomial(2n, n). The sum of its squares is binomial(4n, 2n)/binomial(2n,
/// n)^2.
fn estimate_of_order(differences: &[f64], order: usize) -> Option<OrderEstimate> {
    let variance = central_binomial(order);
    let limit = MAX_DIFFERENCE_OVER_NOISE
        * variance.sqrt()
        * estimate_noise_of_differences(differences, variance)?;
    let squares = differences
        .iter()
        .filter(|d| d.abs() <= limit)
        .map(|d| d * d);
    let (count, sum) = squares.fold((0.0, 0.0), |(count, sum), square| {
        (count + 1.0, sum + square)
    });
    let correlation = central_binomial(2 * order) / variance.powi(2);
    Some(OrderEstimate {
        noise: (sum / count / variance).sqrt(),
        relative_error: (correlation / (2.0 * count)).sqrt(),
    })
}

/// Returns binomial(2n, n).
fn central_binomial(n: usize) -> f64 {
    (1..=n)
        .map(|k| (2.0 * (2.0 * k as f64 - 1.0)) / k as f64)
        .product()
}

/// Returns the standard deviation of white noise from differences, robust against outliers. `variance` is the variance
/// of the differences for noise with a standard deviation of 1. `None` without known differences.
pub(crate) fn estimate_noise_of_differences(differences: &[f64], variance: f64) -> Option<f64> {
    let known = differences
        .iter()
        .map(|d| d.abs())
        .filter(|d| d.is_finite());
    let median = median(&known.collect::<Vec<f64>>())?;
    Some(median / NORMAL_MEDIAN / variance.sqrt())
}

fn estimate_resolution(column: &[f64]) -> Option<f64> {
    let mut values: Vec<f64> = column.iter().copied().filter(|v| v.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let largest = values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    // Differences in the last digits of a double are rounding errors.
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let steps = steps.filter(|step| *step > 1e-12 * largest);
    steps.min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::estimate_noise;

    /// Returns nearly normal numbers with mean 0 and standard deviation 1.
    fn draw_normal_numbers(count: usize) -> Vec<f64> {
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
            let noise = draw_normal_numbers(4000).into_iter().enumerate();
            noise.map(|(k, n)| motion(k) + sd * n).collect()
        };
        for sd in [1e-5, 1e-3, 0.1] {
            let found = estimate_noise(&noisy(sd)).expect("noise");
            assert!((found / sd - 1.0).abs() < 0.05, "{sd}: {found}");
        }
        let step = 2.0 * std::f64::consts::PI / 4096.0;
        let rounded: Vec<f64> = (0..4000)
            .map(|k| (motion(k) / step).round() * step)
            .collect();
        let found = estimate_noise(&rounded).expect("noise");
        assert!(found > 0.9 * step / 12f64.sqrt() && found < step, "{found}");
        assert_eq!(estimate_noise(&[1.0; 100]), None);
    }

    #[test]
    fn short_columns_have_no_low_estimate() {
        let all = draw_normal_numbers(40 * 400);
        let estimates: Vec<f64> = (0..40)
            .map(|part| {
                let period = 20.0 + 5.0 * part as f64;
                let motion = |k: usize| 100.0 * (std::f64::consts::TAU * k as f64 / period).sin();
                let column: Vec<f64> = (0..400).map(|k| motion(k) + all[400 * part + k]).collect();
                estimate_noise(&column).expect("noise")
            })
            .collect();
        let mean = estimates.iter().sum::<f64>() / 40.0;
        assert!((mean - 1.0).abs() < 0.03, "{mean}: {estimates:?}");
        assert!(
            estimates.iter().all(|found| *found > 0.85 && *found < 1.25),
            "{estimates:?}"
        );
    }
}
