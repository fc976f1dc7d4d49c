//! 0-1 test for chaos: a walk driven by a chaotic series spreads like Brownian motion.
//!
//! G. A. Gottwald, I. Melbourne, "On the implementation of the 0-1 test for chaos", SIAM J. Appl.
//! Dyn. Syst. 8 (2009) 129-145. Sample the series once per forcing period: a flow sampled many
//! times per period of its fastest motion appears regular.

use std::f64::consts::PI;

use super::error::{AnalysisError, check_values, mean};

/// Number of angles c for the median, as in the paper.
const ANGLE_COUNT: usize = 100;
/// Smallest number of values that gives enough lags for a correlation.
const MIN_VALUES: usize = 100;
/// Largest variation that counts as rounding, relative to the largest magnitude.
const MAX_CONSTANT_VARIATION: f64 = 1e-10;

/// Computes the growth rate K: near 1 for chaos, near 0 for periodic and quasi-periodic motion.
///
/// For each of 100 angles c in (pi/5, 4 pi/5), the values phi(j) without their mean drive
///
/// ```text
/// p(n) = sum_{j<=n} phi(j) cos(j c),     q(n) = sum_{j<=n} phi(j) sin(j c)
/// D(n) = mean_{j<=N-L} (p(j+n) - p(j))^2 + (q(j+n) - q(j))^2,     n = 1 .. L = N/10
/// K_c = correlation of (1 .. L) with (D(1) .. D(L))
/// ```
///
/// and K is the median of K_c. Because the mean is subtracted, D is the modified displacement of the paper,
/// without the oscillating term (mean phi)^2 (1 - cos n c)/(1 - cos c). The angles follow the golden-ratio
/// sequence, so K is deterministic. A series that is constant to 10^-10 of its magnitude (a fixed point of the
/// section) has K = 0. The cost is about 10 N^2 steps.
///
/// # Errors
///
/// Fewer than 100 values, values that are not finite.
pub fn chaos_indicator(values: &[f64]) -> Result<f64, AnalysisError> {
    check_values(values, MIN_VALUES)?;
    let average = mean(values);
    let series: Vec<f64> = values.iter().map(|value| value - average).collect();
    let largest = |series: &[f64]| series.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let spread = largest(&series);
    if spread <= MAX_CONSTANT_VARIATION * largest(values) {
        return Ok(0.0);
    }
    // Scaling prevents overflow and underflow of squares.
    let series: Vec<f64> = series.iter().map(|value| value / spread).collect();
    let mut rates: Vec<f64> = angles().map(|angle| growth(&series, angle)).collect();
    rates.sort_by(f64::total_cmp);
    let middle = rates
        .get(ANGLE_COUNT / 2 - 1..=ANGLE_COUNT / 2)
        .unwrap_or_default();
    Ok(mean(middle))
}

/// Returns the golden-ratio sequence on (pi/5, 4 pi/5). It is evenly distributed for any number of angles, and
/// not resonant with motions of short period.
fn angles() -> impl Iterator<Item = f64> {
    let golden = (5_f64.sqrt() - 1.0) / 2.0;
    (1..=ANGLE_COUNT).map(move |i| PI / 5.0 + 3.0 * PI / 5.0 * (i as f64 * golden).fract())
}

/// Computes K_c, the correlation of the mean-square displacement with time.
fn growth(series: &[f64], angle: f64) -> f64 {
    let walk = walk(series, angle);
    let lags = series.len() / 10;
    let starts = walk.len() - lags;
    let displacements: Vec<f64> = (1..=lags)
        .map(|lag| {
            let later = walk.iter().skip(lag);
            let squares = walk.iter().zip(later).take(starts);
            squares
                .map(|(a, b)| (b.0 - a.0).powi(2) + (b.1 - a.1).powi(2))
                .sum::<f64>()
                / starts as f64
        })
        .collect();
    correlation_with_index(&displacements)
}

/// Returns the points (p, q).
fn walk(series: &[f64], angle: f64) -> Vec<(f64, f64)> {
    series
        .iter()
        .enumerate()
        .scan((0.0, 0.0), |(p, q), (j, value)| {
            let (sine, cosine) = ((j + 1) as f64 * angle).sin_cos();
            *p += value * cosine;
            *q += value * sine;
            Some((*p, *q))
        })
        .collect()
}

/// Computes the correlation coefficient of the values with 1, 2, 3, ...; 0 if the values are equal.
fn correlation_with_index(values: &[f64]) -> f64 {
    let average = mean(values);
    let middle = (values.len() as f64 - 1.0) / 2.0;
    let (mut product, mut indices, mut squares) = (0.0, 0.0, 0.0);
    for (n, value) in values.iter().enumerate() {
        let (along, up) = (n as f64 - middle, value - average);
        product += along * up;
        indices += along * along;
        squares += up * up;
    }
    let norm = (indices * squares).sqrt();
    if norm > 0.0 { product / norm } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::{circle, henon, logistic};

    #[test]
    fn chaotic_maps_have_k_near_one() -> Result<(), AnalysisError> {
        // In the paper, series of 2000 values have K = 0.99.
        let x: Vec<f64> = henon(2000).iter().map(|point| point[0]).collect();
        for (name, series) in [("logistic", logistic(4.0, 2000)), ("Henon", x)] {
            let k = chaos_indicator(&series)?;
            assert!((0.98..=1.0).contains(&k), "{name}: {k}");
        }
        Ok(())
    }

    #[test]
    fn regular_motion_has_k_near_zero() -> Result<(), AnalysisError> {
        let two_frequencies: Vec<f64> = (0..2000)
            .map(|n| (f64::from(n) * 2_f64.sqrt()).sin() + 0.5 * (f64::from(n) * 3.3).cos())
            .collect();
        let rotation: Vec<f64> = circle((5_f64.sqrt() - 1.0) / 2.0, 0.8, 2000)
            .iter()
            .map(|x| (std::f64::consts::TAU * x).cos())
            .collect();
        for (name, series) in [
            ("period 4", logistic(3.5, 2000)),
            ("two frequencies", two_frequencies),
            ("circle map", rotation),
        ] {
            let k = chaos_indicator(&series)?;
            // Bounded displacements have a remaining correlation of the order 1/sqrt(200).
            assert!(k.abs() < 0.1, "{name}: {k}");
        }
        Ok(())
    }

    #[test]
    fn k_is_independent_of_origin_and_unit() -> Result<(), AnalysisError> {
        let series = logistic(3.97, 500);
        let micro: Vec<f64> = series.iter().map(|x| 1e-6 * x + 1e-3).collect();
        // The offset costs three of sixteen digits, the sums cost two more.
        assert!((chaos_indicator(&series)? - chaos_indicator(&micro)?).abs() < 1e-9);
        Ok(())
    }

    #[test]
    fn fixed_points_are_regular_and_short_series_rejected() {
        assert_eq!(chaos_indicator(&[0.0; 100]), Ok(0.0));
        let rounding: Vec<f64> = (0..500).map(|n| 1.0 + f64::from(n % 7) * 1e-15).collect();
        assert_eq!(chaos_indicator(&rounding), Ok(0.0));
        assert!(chaos_indicator(&[1.0; 99]).is_err());
        assert!(chaos_indicator(&[f64::INFINITY; 100]).is_err());
    }
}
