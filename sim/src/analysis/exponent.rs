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

/// How many batches: between 10 and 30 a further batch buys little, and batches should be
/// long (B. Schmeiser, "Batch size effects in the analysis of simulation output", Oper. Res.
/// 30 (1982) 556-568).
const BATCHES: usize = 20;

/// The mean exponent from the growths ln(|v_k| / |v_(k-1)|) over intervals of equal length,
/// in s, with its standard error by non-overlapping batch means.
///
/// The n growths are cut into B = 20 batches of m = floor(n/B); the first n - m B, nearest
/// to the transient, are left out. With l_b the growth of batch b over m intervals T,
///
/// ```text
/// l_b = sum of the batch / (m T),     value = sum_b l_b / B
/// standard_error = sqrt( sum_b (l_b - value)^2 / (B (B - 1)) )
/// ```
///
/// The error holds once a batch is longer than the correlation of the growths: it is too
/// small for a series shorter than that, and no error bar covers a transient.
///
/// # Errors
///
/// Fewer than 20 growths, growths that are not finite, a length that is not positive.
pub fn mean_exponent(growths: &[f64], interval: f64) -> Result<Exponent, AnalysisError> {
    check_positive(interval, "the interval of growth")?;
    check(growths, BATCHES)?;
    let length = growths.len() / BATCHES;
    let used = growths.get(growths.len() - length * BATCHES..);
    let rates: Vec<f64> = used
        .unwrap_or_default()
        .chunks_exact(length)
        .map(|batch| mean(batch) / interval)
        .collect();
    let value = mean(&rates);
    let squares: f64 = rates.iter().map(|rate| (rate - value).powi(2)).sum();
    Ok(Exponent {
        value,
        standard_error: (squares / (BATCHES * (BATCHES - 1)) as f64).sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::maps::{henon, logistic, noise};

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
        // An error from 20 batches scatters by 1/sqrt(38), 16 %: three of these.
        assert!(
            (exponent.standard_error / textbook - 1.0).abs() < 0.5,
            "{exponent:?}"
        );
        assert!(exponent.value.abs() < 4.0 * textbook, "{exponent:?}");
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
