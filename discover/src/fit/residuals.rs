//! Residuals of an estimate on a set of records, for each channel and block of time, and their
//! correlation.

use crate::fit::gauss_newton::Estimate;
use crate::fit::shooting::Shooting;
use crate::ids::WindowId;
use crate::thresholds;
use eomgen_records::windows::{Window, compared_samples};

/// Residuals of a set of records.
#[derive(Clone, Debug, Default)]
pub struct Residuals {
    /// Unknowns, initial states and sums of squares.
    pub estimate: Estimate,
    /// Residuals of each window, in standard deviations.
    pub window_residuals: Vec<Vec<f64>>,
    /// Sum of squares of each block of time.
    pub block_squares: Vec<f64>,
    /// RMS of each channel, SI.
    pub channel_rms: Vec<f64>,
    /// RMS of each channel, in standard deviations.
    pub normalised_rms: Vec<f64>,
    /// RMS of all channels, in standard deviations.
    pub rms: f64,
    /// Number of measurements, without missing ones.
    pub measurement_count: f64,
    /// Correlation length of the residuals, in samples.
    pub correlation_length: f64,
    /// Windows whose simulation failed. The other fields contain the remaining windows only.
    pub failed_windows: Vec<WindowId>,
}

impl Residuals {
    /// Returns the residuals; if the simulation of a window failed, with infinite values, because
    /// the other windows are not representative.
    pub fn or_infinite(mut self) -> Self {
        if !self.failed_windows.is_empty() {
            self.rms = f64::INFINITY;
            self.channel_rms.fill(f64::INFINITY);
            self.normalised_rms.fill(f64::INFINITY);
        }
        self
    }
}

impl Residuals {
    /// Returns the variance of estimates relative to white noise of one standard deviation. It is
    /// at least 1 and increases with the variance of the residuals and their correlation. Residuals
    /// far below the noise do not increase it, because their correlation is due to rounding.
    pub(crate) fn variance_inflation(&self) -> f64 {
        let variance = self.rms * self.rms;
        variance.max(1.0) + (self.correlation_length - 1.0) * variance
    }

    /// Computes the residuals of an estimate.
    pub fn compute(shooting: &Shooting<'_>, estimate: Estimate) -> Self {
        let channels = shooting.channel_count();
        let residuals = shooting.compute_residuals(&estimate.theta, &estimate.initial_states);
        let unfollowed: Vec<WindowId> = WindowId::first(residuals.len())
            .filter(|window| residuals[*window].is_none())
            .collect();
        let residuals: Vec<Vec<f64>> = residuals
            .into_iter()
            .map(|r| r.map(|r| r.values).unwrap_or_default())
            .collect();
        let mut sums = vec![(0.0, 0.0); channels];
        for (window, residual) in shooting.windows.windows.iter().zip(&residuals) {
            for (number, value) in residual.iter().enumerate() {
                if window.measured[number].is_finite() {
                    let sum = &mut sums[number % channels];
                    *sum = (sum.0 + value * value, sum.1 + 1.0);
                }
            }
        }
        let mean_square = |(sum, count): (f64, f64)| if count > 0.0 { sum / count } else { 0.0 };
        let squares: Vec<f64> = sums.iter().map(|sum| mean_square(*sum)).collect();
        let rms = (squares.iter().sum::<f64>() / channels.max(1) as f64).sqrt();
        Self {
            block_squares: sum_block_squares(&residuals),
            channel_rms: squares
                .iter()
                .zip(shooting.noise)
                .map(|(s, noise)| s.sqrt() * noise)
                .collect(),
            normalised_rms: squares.iter().map(|s| s.sqrt()).collect(),
            rms,
            measurement_count: sums.iter().map(|(_, count)| count).sum(),
            correlation_length: compute_correlation_samples(&residuals, channels),
            window_residuals: residuals,
            estimate,
            failed_windows: unfollowed,
        }
    }
}

/// Returns the residuals of one channel at the samples of a window, in standard deviations. NaN at
/// samples that are missing or not compared, and if the simulation failed.
pub(crate) fn channel_residuals(
    window: &Window,
    residual: &[f64],
    (channel, channels): (usize, usize),
) -> Vec<f64> {
    let samples = window.times.len();
    let inside = compared_samples(samples);
    let value = |sample: usize| {
        let number = sample * channels + channel;
        let is_compared = inside.contains(&sample) && window.measured[number].is_finite();
        let value = residual.get(number).copied();
        value.filter(|_| is_compared).unwrap_or(f64::NAN)
    };
    (0..samples).map(value).collect()
}

/// Returns sums of squares over blocks of time. Windows are split to obtain about
/// `TIME_BLOCK_COUNT` blocks.
fn sum_block_squares(residuals: &[Vec<f64>]) -> Vec<f64> {
    let parts = thresholds::TIME_BLOCK_COUNT.div_ceil(residuals.len().max(1));
    let of_window = |residual: &Vec<f64>| {
        let size = residual.len().div_ceil(parts).max(1);
        let sums = residual
            .chunks(size)
            .map(|part| part.iter().map(|r| r * r).sum::<f64>());
        sums.collect::<Vec<f64>>()
    };
    residuals.iter().flat_map(of_window).collect()
}

/// Returns the correlation length of residuals in samples, for the channel with the longest
/// correlation. It is 1 plus twice the sum of the autocorrelations up to the first that is
/// negligible.
pub(crate) fn compute_correlation_samples(residuals: &[Vec<f64>], channels: usize) -> f64 {
    let of_channel = |channel: usize| {
        let columns: Vec<Vec<f64>> = residuals
            .iter()
            .map(|r| r.iter().skip(channel).step_by(channels).copied().collect())
            .collect();
        let longest = columns.iter().map(Vec::len).max().unwrap_or(0);
        let at = |lag: usize| -> f64 {
            let products = columns.iter().map(|c| {
                c.iter()
                    .zip(c.iter().skip(lag))
                    .map(|(a, b)| a * b)
                    .sum::<f64>()
            });
            products.sum()
        };
        let whole = at(0);
        let mut time = 1.0;
        for lag in 1..longest / 2 {
            let part = at(lag) / whole;
            // Smaller values occur by chance in white noise.
            if part.is_nan() || part < thresholds::MIN_AUTOCORRELATION {
                break;
            }
            time += 2.0 * part;
        }
        time
    };
    (0..channels).map(of_channel).fold(1.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::Residuals;

    fn inflation(rms: f64, correlation: f64) -> f64 {
        let residuals = Residuals {
            rms,
            correlation_length: correlation,
            ..Residuals::default()
        };
        residuals.variance_inflation()
    }

    #[test]
    fn correlation_of_rounding_does_not_widen_intervals() {
        assert_eq!(inflation(1e-13, 2.0), 1.0);
        assert_eq!(inflation(0.0, 9.0), 1.0);
        assert_eq!(inflation(1.0, 3.0), 3.0);
        assert_eq!(inflation(2.0, 3.0), 12.0);
    }
}
