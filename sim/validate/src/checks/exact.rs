//! Comparison of the exact solver's state derivative with the variant's rates in every regime.

use super::super::certificate::{Check, Worst};
use super::super::oracle::{Oracle, OracleError};
use super::super::variant::Variant;
use super::regime_interiors::interior_samples;

const NAME: &str = "exact_derivative";
/// Tolerance relative to the magnitudes of a rate's terms. The exact solver sums them in another order.
const TOLERANCE: f64 = 1e-11;
const STATES_PER_REGIME: usize = 20;
const SEED: u64 = 0x0e4a_c7d5;

/// State derivative with the scale of its rounding error.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaledRates {
    /// Rates of the state.
    pub rates: Vec<f64>,
    /// Sum of the magnitudes of each rate's terms.
    pub magnitudes: Vec<f64>,
}

/// Function that returns the derivative at a time, a state and inputs, or an error message.
pub type Derivative<'d> = dyn Fn(f64, &[f64], &[f64]) -> Result<ScaledRates, String> + 'd;

/// Compares `derivative` with the rates of `variant`.
pub fn check(
    oracle: &Oracle,
    variant: &mut dyn Variant,
    derivative: &Derivative<'_>,
) -> Result<Check, OracleError> {
    let worst = interior_samples(oracle, variant, STATES_PER_REGIME, SEED)?.and_then(|samples| {
        let mut worst = Worst::default();
        for (count, sample) in samples.iter().enumerate() {
            let mut expected = vec![f64::NAN; sample.state.len()];
            variant.rates(sample.time, &sample.state, &sample.inputs, &mut expected)?;
            let found = derivative(sample.time, &sample.state, &sample.inputs)?;
            worst.include(Worst::from_deviation(
                rate_deviation(&found, &expected),
                format!("state {}", count + 1),
            ));
        }
        Ok(worst.with_count(samples.len(), "states"))
    });
    let worst = worst.unwrap_or_else(|message| Worst::from_deviation(f64::INFINITY, message));
    Ok(Check::from_deviation(NAME, worst, TOLERANCE))
}

/// Returns the skipped check (not applicable) of a model without an exact solution.
pub fn skipped_check(reason: impl Into<String>) -> Check {
    Check::not_applicable(NAME, TOLERANCE, reason)
}

/// Returns the largest deviation relative to the magnitudes; NaN counts as infinity.
fn rate_deviation(found: &ScaledRates, expected: &[f64]) -> f64 {
    if found.rates.len() != expected.len() || found.magnitudes.len() != expected.len() {
        return f64::INFINITY;
    }
    let terms = found.rates.iter().zip(&found.magnitudes).zip(expected);
    let deviations = terms.map(|((found, size), expected)| {
        let difference = (found - expected).abs();
        if difference == 0.0 {
            0.0
        } else {
            difference / size
        }
    });
    deviations.fold(
        0.0,
        |worst, deviation| {
            if deviation <= worst { worst } else { deviation }
        },
    )
}
