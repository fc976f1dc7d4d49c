//! Single numbers of a time history, from samples.

/// Returns the greatest value, or `None` without values.
pub fn greatest(values: &[f64]) -> Option<f64> {
    values.iter().copied().reduce(f64::max)
}

/// Computes the RMS over the time between the first and the last sample, by the trapezoidal rule.
/// `times` (s) ascend and belong to `values`. Returns `None` with fewer than two samples.
pub fn root_mean_square(times: &[f64], values: &[f64]) -> Option<f64> {
    let whole = times.last()? - times.first()?;
    let steps = times.windows(2).zip(values.windows(2));
    let squares = steps.map(|(t, x)| 0.5 * (t[1] - t[0]) * (x[0] * x[0] + x[1] * x[1]));
    let mean = squares.sum::<f64>() / whole;
    (whole > 0.0).then(|| mean.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rms_of_a_sine_is_the_root_of_a_half() {
        // Over whole periods, the trapezoidal rule is exact for the square of a sine.
        let times: Vec<f64> = (0..=50).map(|i| f64::from(i) / 50.0).collect();
        let sine = |t: &f64| (std::f64::consts::TAU * t).sin();
        let values: Vec<f64> = times.iter().map(sine).collect();
        let found = root_mean_square(&times, &values).expect("a number");
        assert!((found - 0.5_f64.sqrt()).abs() < 1e-15, "{found}");
    }

    #[test]
    fn rms_needs_two_samples() {
        assert_eq!(root_mean_square(&[1.0], &[2.0]), None);
        assert_eq!(root_mean_square(&[], &[]), None);
        assert_eq!(greatest(&[]), None);
        assert_eq!(greatest(&[-3.0, -1.0, -2.0]), Some(-1.0));
    }
}
