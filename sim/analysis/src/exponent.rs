//! The mean exponent of a series of logarithmic growths, and how well it is known.
//!
//! The growths come from whoever carries the tangent vectors; that is not done here.

use super::error::{AnalysisError, check, check_positive, mean};

/// An exponent with its spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent {
    /// The mean growth rate, 1/s.
    pub value: f64,
    /// Its standard error, 1/s.
    pub standard_error: f64,
}

/// How many batches, the least long ones first, and Student's factor for so many: what a
/// standard error from them has to be taken times to hold the truth in 68 % of all cases.
///
/// Between 10 and 30 a further batch buys little, and batches should be long (B. Schmeiser,
/// "Batch size effects in the analysis of simulation output", Oper. Res. 30 (1982) 556-568).
const BATCHES: [(usize, f64); 3] = [(20, 1.027), (10, 1.059), (5, 1.142)];

/// The fewest growths from which there is an exponent.
pub const FEWEST: usize = BATCHES[0].0;

/// The mean exponent from the growths ln(|v_k| / |v_(k-1)|) over intervals of equal length,
/// in s, with its standard error by non-overlapping batch means.
///
/// The n growths are cut into B batches of m = floor(n/B); the first n - m B, nearest to the
/// transient, are left out. With l_b the growth of batch b over m intervals T,
///
/// ```text
/// l_b = sum of the batch / (m T),     mean = sum_b l_b / B
/// error_B = s_B sqrt( sum_b (l_b - mean)^2 / (B (B - 1)) )
/// value = the mean for B = 20,     standard_error = max(error_20, error_10, error_5)
/// ```
///
/// with s_B Student's factor. An error from batches shorter than the correlation of the growths
/// is too small, and those of growing batches rise until the batches are longer than it: a
/// nearly undamped vibration makes chaos come and go over hundreds of forcing periods. The
/// greatest of three overstates the error of growths without correlation by a fourth. No error
/// bar covers a transient, or a correlation longer than a fifth of the series.
///
/// # Errors
///
/// Fewer than 20 growths, growths that are not finite, a length that is not positive.
pub fn mean_exponent(growths: &[f64], interval: f64) -> Result<Exponent, AnalysisError> {
    check_positive(interval, "the interval of growth")?;
    check(growths, FEWEST)?;
    let means = BATCHES.map(|(batches, factor)| {
        let (mean, error) = batch_mean(growths, batches);
        (mean / interval, factor * error / interval)
    });
    Ok(Exponent {
        value: means[0].0,
        standard_error: means.iter().fold(0.0, |most, (_, error)| error.max(most)),
    })
}

/// The mean of batch means and its standard error.
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
    fn the_logistic_map_has_ln_two() -> Result<(), AnalysisError> {
        let growths: Vec<f64> = logistic(4.0, 100_000)
            .iter()
            .map(|x| (4.0 - 8.0 * x).abs().ln())
            .collect();
        let exponent = mean_exponent(&growths, 1.0)?;
        let ln_two = std::f64::consts::LN_2;
        // Four standard errors: once in 1000 by Student's distribution with 19 degrees.
        assert!((exponent.value - ln_two).abs() < 4.0 * exponent.standard_error);
        assert!(exponent.standard_error < 5e-3, "{exponent:?}");
        Ok(())
    }

    #[test]
    fn henons_map_has_its_published_exponent() -> Result<(), AnalysisError> {
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
        // Half a second per step: twice the exponent per second.
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
        // Below by three times the 16 % by which an error from 20 batches scatters; above by
        // twice the 35 % of one from 5 with its factor: the greatest counts.
        let ratio = exponent.standard_error / textbook;
        assert!((0.5..2.0).contains(&ratio), "{exponent:?}");
        assert!(exponent.value.abs() < 4.0 * textbook, "{exponent:?}");
        Ok(())
    }

    #[test]
    fn correlated_growths_have_the_error_that_their_means_scatter_by() -> Result<(), AnalysisError>
    {
        // Each growth remembers 0.95 of the one before: 40 intervals of correlation in series of
        // 400, as in the arm's chaos.
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
        // 200 series know the scatter to 5 %. Batches of 20 alone would state 0.61 of it.
        assert!(
            (0.85..1.3).contains(&(stated / scatter)),
            "{stated} {scatter}"
        );
        Ok(())
    }

    #[test]
    fn steady_growth_has_no_error_and_short_series_are_refused() -> Result<(), AnalysisError> {
        let steady = mean_exponent(&[0.25; 47], 0.5)?;
        assert_eq!((steady.value, steady.standard_error), (0.5, 0.0));
        assert!(mean_exponent(&[0.0; 19], 1.0).is_err());
        assert!(mean_exponent(&[0.0; 20], -1.0).is_err());
        assert!(mean_exponent(&[f64::NEG_INFINITY; 20], 1.0).is_err());
        Ok(())
    }
}
