//! Times of computed outputs: the samples, and intermediate times if a delayed sensor is
//! interpolated.

use std::borrow::Cow;

use eomgen_records::dataset::Dataset;

use crate::thresholds;

/// Number of computed outputs per sample interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutputRate(usize);

/// Times of computed outputs, s.
#[derive(Clone, Debug)]
pub struct OutputTimes<'s> {
    /// Sample times and intermediate times.
    pub times: Cow<'s, [f64]>,
    rate: usize,
}

impl OutputRate {
    /// Outputs at the samples only.
    #[cfg(test)]
    pub const SAMPLES: Self = Self(1);

    /// Selects the number of outputs per sample interval for which interpolation by a cubic has an
    /// error below a fraction of the noise. For smooth motion the error is estimated from the
    /// records: every second sample predicts the sample between with 16 times the error, from which
    /// the contribution of the noise is subtracted. `jump_errors`: error of each channel due to
    /// jumps of the inputs at the samples, SI. From `RATE_BETWEEN_SAMPLES` on, the four points of a
    /// cubic are in one sample interval, which removes this error.
    pub fn select(dataset: &Dataset, jump_errors: &[f64]) -> Self {
        // A given motion is known at its samples.
        if dataset.gives_motion() {
            return Self(1);
        }
        let channels = dataset.channels.iter().enumerate();
        let error = channels.map(|(index, channel)| {
            let records = dataset.train.iter();
            let columns = records.map(|record| (&record.times[..], &record.channels[index][..]));
            estimate_cubic_error(columns, channel.noise) / channel.noise
        });
        let mut error = error.fold(0.0, f64::max);
        let mut rate = 1;
        while error > thresholds::MAX_INTERPOLATION_ERROR
            && rate < thresholds::MAX_OUTPUTS_PER_SAMPLE
        {
            rate *= 2;
            error /= CUBIC_ERROR_RATIO;
        }
        let jumps = dataset.channels.iter().zip(jump_errors);
        let mut jumps = jumps.map(|(channel, error)| error / channel.noise);
        if jumps.any(|error| error > thresholds::MAX_INTERPOLATION_ERROR) {
            rate = rate.max(RATE_BETWEEN_SAMPLES);
        }
        Self(rate)
    }

    /// Returns the output times for given sample times.
    pub fn times(self, samples: &[f64]) -> OutputTimes<'_> {
        if self.0 == 1 {
            return OutputTimes {
                times: samples.into(),
                rate: 1,
            };
        }
        let mut times = Vec::with_capacity(self.0 * samples.len());
        for pair in samples.windows(2) {
            let step = (pair[1] - pair[0]) / self.0 as f64;
            times.extend((0..self.0).map(|index| pair[0] + index as f64 * step));
        }
        times.extend(samples.last());
        OutputTimes {
            times: times.into(),
            rate: self.0,
        }
    }
}

impl OutputTimes<'_> {
    /// Returns the number of samples.
    pub fn samples(&self) -> usize {
        self.times.len().div_ceil(self.rate)
    }

    /// Selects the entries at the samples from one entry per time.
    pub fn at_samples<T>(&self, all: Vec<T>) -> Vec<T> {
        all.into_iter().step_by(self.rate).collect()
    }

    /// Returns the index of the first of `count` neighbouring times for the interpolation in the
    /// interval that begins at index `before`. If possible, all these times are in one sample
    /// interval.
    pub fn first_node(&self, before: usize, count: usize) -> usize {
        let last = self.times.len() - count;
        let centred = before.saturating_sub(count / 2 - 1).min(last);
        if self.rate + 1 < count {
            return centred;
        }
        let sample = (before / self.rate * self.rate).min(self.times.len() - 1 - self.rate);
        centred.clamp(sample, sample + self.rate + 1 - count)
    }

    /// Returns the index of a sample among the times.
    pub fn of_sample(&self, sample: usize) -> usize {
        sample * self.rate
    }
}

/// Minimum number of outputs per sample interval for which the four points of a cubic are in one
/// interval. Held inputs jump only at samples.
const RATE_BETWEEN_SAMPLES: usize = 4;

/// Ratio of the errors of a cubic for point distances of 2 h and h.
const CUBIC_ERROR_RATIO: f64 = 16.0;

/// Returns the RMS error of a cubic through every second sample of a column, at the middle sample.
fn estimate_cubic_error<'c>(
    columns: impl Iterator<Item = (&'c [f64], &'c [f64])>,
    noise: f64,
) -> f64 {
    let (mut sum, mut expected, mut count) = (0.0, 0.0, 0.0);
    for (times, values) in columns {
        for middle in 3..times.len().saturating_sub(3) {
            let nodes = [middle - 3, middle - 1, middle + 1, middle + 3];
            let weights = nodes.map(|node| {
                let others = nodes.iter().copied();
                compute_lagrange_weight(times, others, node, times[middle])
            });
            let pairs = nodes.iter().zip(&weights);
            let between: f64 = pairs.map(|(node, weight)| weight * values[*node]).sum();
            let error = between - values[middle];
            if error.is_finite() {
                sum += error * error;
                expected += 1.0 + weights.iter().map(|weight| weight * weight).sum::<f64>();
                count += 1.0;
            }
        }
    }
    let square = (sum - noise * noise * expected) / f64::max(count, 1.0);
    square.max(0.0).sqrt() / CUBIC_ERROR_RATIO
}

/// Returns the weight of one of several points at a time, for the polynomial through all points
/// (Lagrange).
pub(crate) fn compute_lagrange_weight(
    times: &[f64],
    points: impl Iterator<Item = usize>,
    own: usize,
    at: f64,
) -> f64 {
    let others = points.filter(|other| *other != own);
    others
        .map(|other| (at - times[other]) / (times[own] - times[other]))
        .product()
}

#[cfg(test)]
mod tests {
    use super::{OutputRate, estimate_cubic_error};

    #[test]
    fn cubic_error_of_sine_matches_remainder_term() {
        // Error in the middle between samples with a distance of 0.1 rad: 9/16 of 0.1^4/24 of the
        // fourth derivative.
        let times: Vec<f64> = (0..2000).map(|i| 0.1 * f64::from(i)).collect();
        let values: Vec<f64> = times.iter().map(|t| t.sin()).collect();
        let found = estimate_cubic_error(std::iter::once((&times[..], &values[..])), 0.0);
        let expected = 9.0 / 16.0 * 1e-4 / 24.0 / f64::sqrt(2.0);
        assert!((found / expected - 1.0).abs() < 0.05, "{found} {expected}");
    }

    #[test]
    fn output_times_contain_samples() {
        let samples = [0.0, 1.0, 3.0];
        let times = OutputRate(2).times(&samples);
        assert_eq!(*times.times, [0.0, 0.5, 1.0, 2.0, 3.0]);
        assert_eq!(times.samples(), 3);
        assert_eq!(times.times[times.of_sample(2)], 3.0);
        assert_eq!(*OutputRate::SAMPLES.times(&samples).times, samples);
    }

    #[test]
    fn cubics_cross_samples_only_if_an_interval_has_too_few_times() {
        let samples = [0.0, 1.0, 2.0, 3.0];
        let nodes = |rate: usize| {
            let times = OutputRate(rate).times(&samples);
            let nodes = (0..times.times.len()).map(|before| times.first_node(before, 4));
            nodes.collect::<Vec<usize>>()
        };
        assert_eq!(nodes(1), [0, 0, 0, 0]);
        assert_eq!(nodes(2), [0, 0, 1, 2, 3, 3, 3]);
        assert_eq!(nodes(4), [0, 0, 1, 1, 4, 4, 5, 5, 8, 8, 9, 9, 9]);
    }
}
