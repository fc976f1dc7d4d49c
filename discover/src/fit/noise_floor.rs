//! Noise floor: residuals of a correct model. A replica of the records (parametric bootstrap: Efron
//! 1979), simulated by the fitted model with the noise of the sensors, is processed like the
//! records. The floor so includes noise, its amplification by the motion, and the error of the
//! initial states.

use crate::fit::fit_result::Fit;
use crate::fit::gauss_newton::evaluate_cost;
use crate::fit::initial_states;
use crate::fit::prior::InitialStatePrior;
use crate::fit::residuals::Residuals;
use crate::fit::shooting::Shooting;
use crate::model::problem::EstimationProblem;
use eomgen_records::record::Record;
use eomgen_records::windows::Windows;
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// Residuals of a correct model.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseFloor {
    /// RMS of each channel, SI.
    pub channels: Vec<f64>,
    /// RMS of all channels, in standard deviations.
    pub rms: f64,
}

/// Computes the noise floor of a fit. `seed`: seed of the noise.
pub fn compute_noise_floor(problem: &EstimationProblem<'_>, fit: &Fit, seed: u64) -> NoiseFloor {
    let noise_alone = NoiseFloor {
        channels: problem.noise.clone(),
        rms: 1.0,
    };
    let Some(records) = replicas(problem, fit, seed) else {
        return noise_alone;
    };
    let windows = Windows::split_records(&records, problem.dataset.window);
    let shooting = Shooting::new(problem, &fit.model, &windows, &fit.unknowns, &fit.ranges);
    let theta = fit.train.estimate.theta.clone();
    let Ok(initial_states) = initial_states::estimate_best(problem, &shooting, &theta, &fit.ranges)
    else {
        return noise_alone;
    };
    let estimate = evaluate_cost(
        &shooting,
        &InitialStatePrior::default(),
        theta,
        initial_states,
    );
    let residuals = Residuals::compute(&shooting, estimate).or_infinite();
    if !residuals.rms.is_finite() {
        return noise_alone;
    }
    NoiseFloor {
        channels: residuals.channel_rms,
        rms: residuals.rms.max(f64::MIN_POSITIVE),
    }
}

/// The training records as the fitted model would have made them.
fn replicas(problem: &EstimationProblem<'_>, fit: &Fit, seed: u64) -> Option<Vec<Record>> {
    let shooting = fit.training_shooting(problem);
    let theta = &fit.train.estimate.theta;
    let sensors = shooting.sensor_values(theta);
    let mut simulation = fit
        .model
        .create_simulation(&shooting.parameter_values(theta))
        .ok()?;
    let mut draw = Normal::new(seed ^ 0x9e37_79b9_7f4a_7c15);
    let mut replicas = Vec::new();
    for record in &problem.dataset.train {
        let first = problem.estimate_first_state(&fit.model, record);
        let times = problem.output_rate.times(&record.times);
        let outputs = simulation
            .simulate_outputs(&first, &times.times, &record.inputs)
            .ok()?;
        let seen = shooting.apply_sensors(&times, &sensors, &outputs.values);
        let count = problem.noise.len();
        let mut replica = record.clone();
        for (channel, column) in replica.channels.iter_mut().enumerate() {
            for (sample, value) in column.iter_mut().enumerate() {
                if value.is_finite() {
                    *value = seen[sample * count + channel] + problem.noise[channel] * draw.next();
                }
            }
        }
        replicas.push(replica);
    }
    Some(replicas)
}

/// Normal numbers from a seed: sums of twelve uniform ones, less six. Their tails end at six,
/// which no sum of squares notices.
struct Normal(SplitMix64);

impl Normal {
    fn new(seed: u64) -> Self {
        Self(SplitMix64::seed_from_u64(seed))
    }

    fn next(&mut self) -> f64 {
        let uniform = (0..12).map(|_| (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64);
        uniform.sum::<f64>() - 6.0
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_noise_is_normal_in_mean_and_variance() {
        let mut draw = super::Normal::new(1);
        let values: Vec<f64> = (0..20_000).map(|_| draw.next()).collect();
        let mean = values.iter().sum::<f64>() / 2e4;
        let variance = values.iter().map(|v| v * v).sum::<f64>() / 2e4;
        // Five standard errors: 1/sqrt(n) and sqrt(2/n).
        assert!(mean.abs() < 0.036 && (variance - 1.0).abs() < 0.05);
    }
}
