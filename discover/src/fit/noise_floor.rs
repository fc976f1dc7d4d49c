//! Noise floor: residuals of a correct model. The fitted model and the noise of the sensors
//! generate a replica of the records (parametric bootstrap: Efron 1979), which is processed like
//! the records. The noise floor therefore includes noise, its amplification by the motion, and the
//! error of the initial states.

use crate::fit::fit_result::Fit;
use crate::fit::gauss_newton::evaluate_cost;
use crate::fit::initial_states;
use crate::fit::prior::InitialStatePrior;
use crate::fit::residuals::Residuals;
use crate::fit::shooting::Shooting;
use crate::model::problem::EstimationProblem;
use eomgen_records::record::Record;
use eomgen_records::windows::{Windows, compared_samples};
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
///
/// The squares of the residual are divided by the squares of the generated noise, so that the noise
/// floor does not depend on the random size of this noise.
pub fn compute_noise_floor(problem: &EstimationProblem<'_>, fit: &Fit, seed: u64) -> NoiseFloor {
    let noise_alone = NoiseFloor {
        channels: problem.noise.clone(),
        rms: 1.0,
    };
    let Some(replicas) = generate_replicas(problem, fit, seed) else {
        return noise_alone;
    };
    let windows = Windows::split_records(&replicas.records, problem.dataset.window);
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
    let noise = Windows::split_records(&replicas.noise, problem.dataset.window);
    let drawn = compute_mean_squares(&noise, problem.noise.len());
    let ratios = residuals.normalised_rms.iter().zip(&drawn);
    let ratios: Vec<f64> = ratios.map(|(rms, drawn)| rms / drawn.sqrt()).collect();
    let squares: f64 = ratios.iter().map(|ratio| ratio * ratio).sum();
    let channels = ratios.iter().zip(&problem.noise);
    NoiseFloor {
        channels: channels.map(|(ratio, noise)| ratio * noise).collect(),
        rms: (squares / ratios.len().max(1) as f64)
            .sqrt()
            .max(f64::MIN_POSITIVE),
    }
}

/// Returns the mean square of the noise of each channel at the compared samples, or 1 for a channel
/// without measurements. `noise`: noise in standard deviations.
fn compute_mean_squares(noise: &Windows<'_>, channels: usize) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); channels];
    for window in &noise.windows {
        let rows = window.measured.chunks(channels.max(1));
        let compared = compared_samples(window.times.len());
        for row in rows.skip(compared.start).take(compared.len()) {
            for (value, (sum, count)) in row.iter().zip(&mut sums) {
                if value.is_finite() {
                    *sum += value * value;
                    *count += 1.0;
                }
            }
        }
    }
    let mean = |(sum, count): &(f64, f64)| if *count > 0.0 { sum / count } else { 1.0 };
    sums.iter().map(mean).collect()
}

/// Replica of the records and its noise.
struct Replicas {
    records: Vec<Record>,
    /// Noise of the replica, in standard deviations.
    noise: Vec<Record>,
}

/// Generates a replica of the training records with the fitted model.
fn generate_replicas(problem: &EstimationProblem<'_>, fit: &Fit, seed: u64) -> Option<Replicas> {
    let shooting = fit.training_shooting(problem);
    let theta = &fit.train.estimate.theta;
    let sensors = shooting.sensor_values(theta);
    let mut simulation = fit
        .model
        .create_simulation(&shooting.parameter_values(theta))
        .ok()?;
    let mut draw = NormalGenerator::new(seed ^ 0x9e37_79b9_7f4a_7c15);
    let mut replicas = Replicas {
        records: Vec::new(),
        noise: Vec::new(),
    };
    for record in &problem.dataset.train {
        let first = problem.estimate_first_state(&fit.model, record);
        let times = problem.output_rate.times(&record.times);
        let outputs = simulation
            .simulate_outputs(&first, &times.times, &record.inputs)
            .ok()?;
        let seen = shooting.apply_sensors(&times, &sensors, &outputs.values);
        let count = problem.noise.len();
        let (mut replica, mut noise) = (record.clone(), record.clone());
        let columns = replica.channels.iter_mut().zip(&mut noise.channels);
        for (channel, (column, noise)) in columns.enumerate() {
            let values = column.iter_mut().zip(noise).enumerate();
            for (sample, (value, noise)) in values.filter(|(_, (value, _))| value.is_finite()) {
                *noise = draw.next();
                *value = seen[sample * count + channel] + problem.noise[channel] * *noise;
            }
        }
        replicas.records.push(replica);
        replicas.noise.push(noise);
    }
    Some(replicas)
}

/// Generator of normal random numbers: sums of twelve uniform numbers, minus six. No number exceeds
/// 6 in magnitude, which hardly affects sums of squares.
struct NormalGenerator(SplitMix64);

impl NormalGenerator {
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
    fn noise_has_normal_mean_and_variance() {
        let mut draw = super::NormalGenerator::new(1);
        let values: Vec<f64> = (0..20_000).map(|_| draw.next()).collect();
        let mean = values.iter().sum::<f64>() / 2e4;
        let variance = values.iter().map(|v| v * v).sum::<f64>() / 2e4;
        // Tolerances: five standard errors, 5/sqrt(n) and 5 sqrt(2/n).
        assert!(mean.abs() < 0.036 && (variance - 1.0).abs() < 0.05);
    }
}
