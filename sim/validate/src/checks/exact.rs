//! The derivative that the exact solver integrates against the variant's rates, at states in
//! every regime, some of them where a switching function rests at zero.

use super::super::certificate::{Check, Worst};
use super::super::oracle::{Oracle, OracleError};
use super::super::variant::Variant;
use super::inside::samples;

/// Name of the check.
const NAME: &str = "exact_derivative";
/// Deviation that passes, relative to the sum of the magnitudes that a rate is made of there:
/// the coefficients of linear equations are other sums of the same terms.
const TOLERANCE: f64 = 1e-11;
/// States compared in every regime.
const STATES_PER_REGIME: usize = 20;
/// The seed of the states.
const SEED: u64 = 0x0e4a_c7d5;

/// A derivative and the sizes of what each of its entries is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Sized {
    /// The rates of the state.
    pub rates: Vec<f64>,
    /// For each the sum of the magnitudes of its terms.
    pub sizes: Vec<f64>,
}

/// The derivative at a time, a state and inputs, or what went wrong.
pub type Derivative<'d> = dyn Fn(f64, &[f64], &[f64]) -> Result<Sized, String> + 'd;

/// Compares `derivative` with the rates of `variant`.
///
/// # Errors
/// [`OracleError`] as from [`Oracle::equations`].
pub fn check(
    oracle: &Oracle,
    variant: &mut dyn Variant,
    derivative: &Derivative<'_>,
) -> Result<Check, OracleError> {
    let worst = samples(oracle, variant, STATES_PER_REGIME, SEED)?.and_then(|samples| {
        let mut worst = Worst::default();
        for (count, sample) in samples.iter().enumerate() {
            let mut expected = vec![f64::NAN; sample.state.len()];
            variant.rates(sample.time, &sample.state, &sample.inputs, &mut expected)?;
            let found = derivative(sample.time, &sample.state, &sample.inputs)?;
            worst.include(Worst::of(
                deviation(&found, &expected),
                format!("state {}", count + 1),
            ));
        }
        Ok(worst.among(samples.len(), "states"))
    });
    let worst = worst.unwrap_or_else(|message| Worst::of(f64::INFINITY, message));
    Ok(Check::made(NAME, worst, TOLERANCE))
}

/// The check of a model that the exact solver does not know.
pub fn skipped(reason: impl Into<String>) -> Check {
    Check::not_applicable(NAME, TOLERANCE, reason)
}

/// The largest deviation relative to the sizes; what is no number is infinitely far away.
fn deviation(found: &Sized, expected: &[f64]) -> f64 {
    if found.rates.len() != expected.len() || found.sizes.len() != expected.len() {
        return f64::INFINITY;
    }
    let terms = found.rates.iter().zip(&found.sizes).zip(expected);
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
