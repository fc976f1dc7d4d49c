//! Mean exponent of a series of logarithmic growths, with its standard error.

use super::error::{AnalysisError, check_positive, check_values, mean};

/// Exponent with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent {
    /// Mean growth rate, 1/s.
    pub value: f64,
    /// Standard error, 1/s.
    pub standard_error: f64,
}

/// Numbers of batches, shortest batches first, with Student's factor: the standard error times this factor
/// covers the true value in 68 % of all cases.
///
/// Between 10 and 30, additional batches gain little, and batches should be long (B. Schmeiser, "Batch size
/// effects in the analysis of simulation output", Oper. Res. 30 (1982) 556-568).
const BATCH_COUNTS_AND_FACTORS: [(usize, f64); 3] = [(20, 1.027), (10, 1.059), (5, 1.142)];

/// Smallest number of growths for an exponent.
pub const MIN_GROWTHS: usize = BATCH_COUNTS_AND_FACTORS[0].0;

/// Computes the mean exponent of the growths ln(|v_k| / |v_(k-1)|) over equal intervals (s), with
/// its standard error by non-overlapping batch means.
///
/// The n growths are divided into B batches of m = floor(n/B) growths. The first n - m B growths, nearest to
/// the transient, are omitted. With l_b the growth rate of batch b over m intervals T,
///
/// ```text
/// l_b = sum of the batch / (m T),     mean = sum_b l_b / B
/// error_B = s_B sqrt( sum_b (l_b - mean)^2 / (B (B - 1)) )
/// value = the mean for B = 20,     standard_error = max(error_20, error_10, error_5)
/// ```
///
/// with Student's factor s_B. If the batches are shorter than the correlation time of the growths, the error is
/// too small, and it increases with longer batches. For example, a nearly undamped vibration switches chaos on
/// and off over hundreds of forcing periods. For uncorrelated growths, the largest of three errors is 25 % too
/// large. The error does not cover a transient, nor a correlation longer than a fifth of the series.
///
/// # Errors
///
/// Fewer than 20 growths, growths that are not finite, an interval that is not positive.
pub fn mean_exponent(growths: &[f64], interval: f64) -> Result<Exponent, AnalysisError> {
    check_positive(interval, "the interval of growth")?;
    check_values(growths, MIN_GROWTHS)?;
    let means = BATCH_COUNTS_AND_FACTORS.map(|(batches, factor)| {
        let (mean, error) = batch_mean(growths, batches);
        (mean / interval, factor * error / interval)
    });
    Ok(Exponent {
        value: means[0].0,
        standard_error: means.iter().fold(0.0, |most, (_, error)| error.max(most)),
    })
}

/// Computes the mean of batch means and its standard error.
fn batch_mean(growths: &[f64], batches: usize) -> (f64, f64) {
    let length = growths.len() / batches;
    let used = growths.get(growths.len() - length * batches..);
    let batch_means = used.unwrap_or_default().chunks_exact(length).map(mean);
    let batch_means: Vec<f64> = batch_means.collect();
    let value = mean(&batch_means);
    let squares: f64 = batch_means.iter().map(|mean| (mean - value).powi(2)).sum();
    (value, (squares / (batches * (batches - 1)) as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::{henon, logistic, noise};

    #[test]
    fn logistic_map_has_exponent_ln_two() -> Result<(), AnalysisError> {
        let growths: Vec<f64> = logistic(4.0, 100_000)
            .iter()
            .map(|x| (4.0 - 8.0 * x).abs().ln())
            .collect();
        let exponent = mean_exponent(&growths, 1.0)?;
        let ln_two = std::f64::consts::LN_2;
        // Student's distribution with 19 degrees of freedom exceeds four standard errors once in 1000 cases.
        assert!((exponent.value - ln_two).abs() < 4.0 * exponent.standard_error);
        assert!(exponent.standard_error < 5e-3, "{exponent:?}");
        Ok(())
    }

    #[test]
    fn henon_map_has_its_published_exponent() -> Result<(), AnalysisError> {
        let mut tangent = [1.0, 0.0];
        let growths: Vec<f64> = henon(100_000)
            .iter()
            .map(|[x, _]| {
                let [u, v] = tangent;
                let next = [-2.8 * x * u + v, 0.3 * u];
                let norm = f64::hypot(next[0], next[1]);
                tangent = next.map(|component| component / norm);
                norm.ln()
            })
            .collect();
        // Steps of 0.5 s double the exponent per second.
        let exponent = mean_exponent(&growths, 0.5)?;
        let error = (exponent.value - 2.0 * 0.419_22).abs();
        assert!(
            error < 4.0 * exponent.standard_error && error < 0.02,
            "{exponent:?}"
        );
        Ok(())
    }

    #[test]
    fn independent_growths_have_the_textbook_error() -> Result<(), AnalysisError> {
        let exponent = mean_exponent(&noise(40_013), 1.0)?;
        let textbook = (1.0 / 3.0 / 40_000_f64).sqrt();
        // Lower limit: three times the 16 % scatter of an error from 20 batches. Upper limit: twice the 35 %
        // scatter of an error from 5 batches, because the largest error is used.
        let ratio = exponent.standard_error / textbook;
        assert!((0.5..2.0).contains(&ratio), "{exponent:?}");
        assert!(exponent.value.abs() < 4.0 * textbook, "{exponent:?}");
        Ok(())
    }

    #[test]
    fn error_of_correlated_growths_matches_the_scatter_of_means() -> Result<(), AnalysisError> {
        // Correlation over 40 intervals (factor 0.95) in series of 400, as in the arm's chaos.
        let mut growth = 0.0;
        let growths: Vec<f64> = noise(200 * 400)
            .iter()
            .map(|fresh| {
                growth = 0.95 * growth + fresh;
                growth
            })
            .collect();
        let exponents: Result<Vec<Exponent>, AnalysisError> = growths
            .chunks(400)
            .map(|series| mean_exponent(series, 1.0))
            .collect();
        let exponents = exponents?;
        let square = |of: &dyn Fn(&Exponent) -> f64| {
            mean(
                &exponents
                    .iter()
                    .map(|e| of(e).powi(2))
                    .collect::<Vec<f64>>(),
            )
            .sqrt()
        };
        let scatter = square(&|exponent| exponent.value);
        let stated = square(&|exponent| exponent.standard_error);
        // The scatter of 200 series is known to 5 %. With 20 batches only, the ratio would be 0.61.
        assert!(
            (0.85..1.3).contains(&(stated / scatter)),
            "{stated} {scatter}"
        );
        Ok(())
    }

    #[test]
    fn steady_growth_has_no_error_and_short_series_are_rejected() -> Result<(), AnalysisError> {
        let steady = mean_exponent(&[0.25; 47], 0.5)?;
        assert_eq!((steady.value, steady.standard_error), (0.5, 0.0));
        assert!(mean_exponent(&[0.0; 19], 1.0).is_err());
        assert!(mean_exponent(&[0.0; 20], -1.0).is_err());
        assert!(mean_exponent(&[f64::NEG_INFINITY; 20], 1.0).is_err());
        Ok(())
    }
}
