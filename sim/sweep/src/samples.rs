//! Random samples of the uncertain parameters of a specification.
//!
//! The generator is SplitMix64 (Steele, Lea and Flood 2014) with the transform of Box and Muller (1958) for normal
//! numbers. The project's own functions are bit-identical on every machine. Each number depends only on the seed, the
//! parameter's name and the sample. Shards are therefore independent, and a further uncertain parameter does not change
//! the samples of the others.

use eomgen_model_spec::argument::Argument;
use std::f64::consts::TAU;

use eomgen_codegen::stable_hash::StableHash;
use eomgen_elementary::Function;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::uncertainty::{Distribution, Law};
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

use crate::error::SweepError;
use crate::grid::MAX_POINTS;

/// Maximum number of draws of a normal number within its bounds; after them the mean is used. The bounds are at least
/// one standard deviation away, so all draws fail with a probability of 10^-30.
const MAX_DRAWS: usize = 64;

/// Independent random samples of parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Samples {
    /// Number of samples.
    pub count: usize,
    /// Seed of the sequence.
    pub seed: u64,
    /// Distributions of the parameters.
    pub parameters: Vec<SampledParameter>,
}

/// Distribution of a parameter, in its declared unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "law", rename_all = "snake_case")]
pub enum SampledParameter {
    /// Normal distribution, truncated to the bounds.
    Normal {
        /// Name of the parameter.
        name: String,
        /// Mean.
        mean: f64,
        /// Standard deviation.
        sd: f64,
        /// Lower bound, if any.
        low: Option<f64>,
        /// Upper bound, if any.
        high: Option<f64>,
    },
    /// Uniform distribution.
    Uniform {
        /// Name of the parameter.
        name: String,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
}

impl From<Distribution> for SampledParameter {
    fn from(Distribution { name, law }: Distribution) -> Self {
        match law {
            Law::Normal {
                mean,
                sd,
                bounds: [low, high],
            } => Self::Normal {
                name,
                mean,
                sd,
                low,
                high,
            },
            Law::Uniform { low, high } => Self::Uniform { name, low, high },
        }
    }
}

impl Samples {
    /// Creates samples of the uncertain parameters of a model, around their values.
    ///
    /// # Errors
    /// No uncertain parameter, an undefined uncertainty, or an invalid number of samples.
    pub fn new(model: &Model, count: usize, seed: u64) -> Result<Self, SweepError> {
        let spreads = model.distributions();
        let spreads = spreads.map_err(|error| SweepError::Request(error.to_string()))?;
        if spreads.is_empty() {
            return Err(SweepError::Request(format!(
                "{}: the model `{}` has no uncertain parameter: give at least one parameter an \
                 uncertainty, such as k = {{ value = 50, unit = \"N/m\", uncertainty = {{ relative = 0.02 }} }}",
                Argument::Samples,
                model.name
            )));
        }
        let samples = Self {
            count,
            seed,
            parameters: spreads.into_iter().map(SampledParameter::from).collect(),
        };
        samples.check()?;
        Ok(samples)
    }

    pub(crate) fn check(&self) -> Result<(), SweepError> {
        if (1..=MAX_POINTS).contains(&self.count) {
            return Ok(());
        }
        Err(SweepError::Request(format!(
            "{}: expected a number from 1 to {MAX_POINTS}",
            Argument::Samples.with_number(self.count)
        )))
    }

    /// Returns the sampled parameters.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.parameters.iter().map(SampledParameter::name)
    }

    /// Returns the parameters' values in a sample, in the order of [`Samples::names`].
    pub fn settings(&self, sample: usize) -> Vec<(&str, f64)> {
        let value = |parameter: &SampledParameter| {
            let mut state = self.seed;
            let name = StableHash::new().include(parameter.name().as_bytes());
            for word in [name.value(), sample as u64] {
                state = SplitMix64::seed_from_u64(state ^ word).next_u64();
            }
            parameter.draw(&mut SplitMix64::seed_from_u64(state))
        };
        self.parameters
            .iter()
            .map(|parameter| (parameter.name(), value(parameter)))
            .collect()
    }
}

impl SampledParameter {
    /// Returns the parameter's name.
    pub fn name(&self) -> &str {
        match self {
            Self::Normal { name, .. } | Self::Uniform { name, .. } => name,
        }
    }

    fn draw(&self, random: &mut SplitMix64) -> f64 {
        match *self {
            Self::Uniform { low, high, .. } => {
                (low + (high - low) * draw_unit(random)).clamp(low, high)
            }
            Self::Normal {
                mean,
                sd,
                low,
                high,
                ..
            } => {
                let inside = |value: &f64| {
                    low.is_none_or(|low| low <= *value) && high.is_none_or(|high| *value <= high)
                };
                let mut draws = (0..MAX_DRAWS).map(|_| mean + sd * draw_normal(random));
                draws.find(inside).unwrap_or(mean)
            }
        }
    }
}

fn draw_unit(random: &mut SplitMix64) -> f64 {
    (random.next_u64() >> 11) as f64 * 0.5_f64.powi(53)
}

fn draw_normal(random: &mut SplitMix64) -> f64 {
    // 1 - [0, 1) excludes 0, for which the logarithm is infinite.
    let radius = (-2.0 * Function::Ln.apply(&[1.0 - draw_unit(random)])).sqrt();
    radius * Function::Cos.apply(&[TAU * draw_unit(random)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn normal_law(name: &str, low: Option<f64>) -> SampledParameter {
        let name = name.to_owned();
        SampledParameter::Normal {
            name,
            mean: 3.0,
            sd: 0.5,
            low,
            high: None,
        }
    }

    fn values(parameter: &SampledParameter, seed: u64, count: usize) -> Vec<f64> {
        let samples = Samples {
            count,
            seed,
            parameters: vec![parameter.clone()],
        };
        (0..count)
            .map(|sample| samples.settings(sample)[0].1)
            .collect()
    }

    fn moment(values: &[f64], about: f64, power: i32) -> f64 {
        values
            .iter()
            .map(|value| (value - about).powi(power))
            .sum::<f64>()
            / values.len() as f64
    }

    #[test]
    fn normal_numbers_have_expected_moments() {
        let n = 40_000;
        let values = values(&normal_law("k", None), 1, n);
        let root = (n as f64).sqrt();
        // The tolerances are four standard errors of the first four moments.
        assert!((moment(&values, 0.0, 1) - 3.0).abs() < 4.0 * 0.5 / root);
        assert!((moment(&values, 3.0, 2) - 0.25).abs() < 4.0 * 0.25 * 2_f64.sqrt() / root);
        assert!(moment(&values, 3.0, 3).abs() < 4.0 * 0.125 * 15_f64.sqrt() / root);
        assert!((moment(&values, 3.0, 4) - 3.0 / 16.0).abs() < 4.0 * 96_f64.sqrt() / 16.0 / root);
        let within = values
            .iter()
            .filter(|value| (**value - 3.0).abs() < 0.5)
            .count();
        // erf(1/sqrt(2)) = 0.682689
        assert!((within as f64 / n as f64 - 0.682_689).abs() < 4.0 * 0.4654 / root);
    }

    #[test]
    fn bounds_truncate_and_seeds_names_and_samples_differ() {
        let n = 10_000;
        let cut = values(&normal_law("k", Some(2.5)), 1, n);
        assert!(cut.iter().all(|value| *value >= 2.5));
        // The mean of the truncated normal distribution is phi(1)/Phi(1) = 0.287600 standard deviations above the mean.
        let root = (n as f64).sqrt();
        assert!((moment(&cut, 3.0, 1) - 0.5 * 0.2876).abs() < 4.0 * 0.5 / root);
        let [one, name, seed] = [("k", 1), ("c", 1), ("k", 2)]
            .map(|(name, seed)| values(&normal_law(name, None), seed, n));
        for other in [&name, &seed, &one[1..].to_vec()] {
            let product = one.iter().zip(other).map(|(a, b)| (a - 3.0) * (b - 3.0));
            let correlation = product.sum::<f64>() / (0.25 * n as f64);
            assert!(correlation.abs() < 4.0 / root, "{correlation}");
        }
    }

    #[test]
    fn uniform_numbers_fill_range_evenly() {
        let name = "k".to_owned();
        let values = values(
            &SampledParameter::Uniform {
                name,
                low: -1.0,
                high: 3.0,
            },
            7,
            40_000,
        );
        assert!(values.iter().all(|value| (-1.0..=3.0).contains(value)));
        let root = (values.len() as f64).sqrt();
        assert!((moment(&values, 0.0, 1) - 1.0).abs() < 4.0 * (16.0 / 12.0_f64).sqrt() / root);
        for quarter in 0..4 {
            let from = -1.0 + f64::from(quarter);
            let inside = values
                .iter()
                .filter(|value| (from..from + 1.0).contains(*value))
                .count();
            assert!((inside as f64 / values.len() as f64 - 0.25).abs() < 4.0 * 0.433 / root);
        }
    }
}
