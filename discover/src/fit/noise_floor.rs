//! The floor: what would be left if the model were right. A twin of the records, simulated by
//! the fitted model with the sensors' noise, goes the same way as the records themselves, so
//! that noise, what a motion's own sensitivity makes of it, and what finding initial states
//! costs are all in it.

use crate::fit::full::Fit;
use crate::fit::gauss_newton::{self, StartPrior};
use crate::model::problem::Setting;
use eomgen_records::record::Record;
use eomgen_records::windows::Windows;

/// What a right model would leave.
#[derive(Clone, Debug, PartialEq)]
pub struct Floor {
    /// The root mean square of each channel, SI.
    pub channels: Vec<f64>,
    /// The root mean square of all, in noises.
    pub pooled: f64,
}

/// The floor at a fit; `seed` draws the noise.
pub fn floor(setting: &Setting<'_>, fit: &Fit, seed: u64) -> Floor {
    let noise_alone = Floor {
        channels: setting.noise.clone(),
        pooled: 1.0,
    };
    let Some(records) = twins(setting, fit, seed) else {
        return noise_alone;
    };
    let windows = Windows::cut(&records, setting.dataset.window);
    let shooting = setting.shooting(&fit.plant, &windows, &fit.unknowns, &fit.ranges);
    let theta = fit.train.estimate.theta.clone();
    let Ok(starts) = setting.all_starts(&shooting, &theta, &fit.ranges) else {
        return noise_alone;
    };
    let estimate = gauss_newton::evaluated(&shooting, &StartPrior::default(), theta, starts);
    let rest = setting.rest(&shooting, estimate).whole();
    if !rest.pooled.is_finite() {
        return noise_alone;
    }
    Floor {
        channels: rest.channels,
        pooled: rest.pooled.max(f64::MIN_POSITIVE),
    }
}

/// The training records as the fitted model would have made them.
fn twins(setting: &Setting<'_>, fit: &Fit, seed: u64) -> Option<Vec<Record>> {
    let shooting = setting.shooting(&fit.plant, &setting.train, &fit.unknowns, &fit.ranges);
    let theta = &fit.train.estimate.theta;
    let sensors = shooting.sensors(theta);
    let mut runner = fit.plant.at(&shooting.values(theta)).ok()?;
    let mut draw = Normal(seed ^ 0x9e37_79b9_7f4a_7c15);
    let mut twins = Vec::new();
    for record in &setting.dataset.train {
        let first = setting.first_state(&fit.plant, record);
        let outputs = runner.outputs(&first, &record.times, &record.inputs).ok()?;
        let seen = shooting.seen(&record.times, &sensors, &outputs.values);
        let count = setting.noise.len();
        let mut twin = record.clone();
        for (channel, column) in twin.channels.iter_mut().enumerate() {
            for (sample, value) in column.iter_mut().enumerate() {
                if value.is_finite() {
                    *value = seen[sample * count + channel] + setting.noise[channel] * draw.next();
                }
            }
        }
        twins.push(twin);
    }
    Some(twins)
}

/// Normal numbers from a seed: sums of twelve uniform ones (splitmix64), less six. Their
/// tails end at six, which no sum of squares notices.
struct Normal(u64);

impl Normal {
    fn next(&mut self) -> f64 {
        let uniform = |state: &mut u64| {
            *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = *state;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..12).map(|_| uniform(&mut self.0)).sum::<f64>() - 6.0
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_noise_is_normal_in_mean_and_variance() {
        let mut draw = super::Normal(1);
        let values: Vec<f64> = (0..20_000).map(|_| draw.next()).collect();
        let mean = values.iter().sum::<f64>() / 2e4;
        let variance = values.iter().map(|v| v * v).sum::<f64>() / 2e4;
        // Five standard errors: 1/sqrt(n) and sqrt(2/n).
        assert!(mean.abs() < 0.036 && (variance - 1.0).abs() < 0.05);
    }
}
