//! Unwrapping: recovers the continuous motion from values that are known up to multiples of a period, for example an
//! angle from -180 to 180 degrees or a counter that overflows.

use crate::samples::typical_step;

/// Time step, relative to the typical one, above which there is a gap.
const MIN_GAP_STEPS: f64 = 1.5;

/// Largest difference between the extrapolations over a gap from its two sides, in periods.
const MAX_DIFFERENCE_PERIODS: f64 = 0.25;

/// Number of steps whose median rate predicts the next value; the median is robust against an outlier.
const RECENT_STEPS: usize = 5;

pub(crate) struct UnwrappedColumn {
    /// Values; NaN for a missing sample.
    pub values: Vec<f64>,
    /// Gaps with an unknown number of periods, as times of the samples before and after.
    pub unknown: Vec<(f64, f64)>,
}

/// Unwraps a column from its first sample on. Each later sample gets the number of periods for which it is nearest to
/// the extrapolated motion, which may exceed half a period per sample.
pub(crate) fn unwrap_values(times: &[f64], column: &[f64], period: f64) -> UnwrappedColumn {
    let samples: Vec<usize> = (0..column.len())
        .filter(|sample| column[*sample].is_finite())
        .collect();
    let at: Vec<f64> = samples.iter().map(|sample| times[*sample]).collect();
    let longest = MIN_GAP_STEPS * typical_step(&at);
    let motion = WrappedColumn {
        times: at,
        values: samples.iter().map(|sample| column[*sample]).collect(),
        period,
        longest_step: longest,
    };
    let mut values = column.to_vec();
    let mut unknown = Vec::new();
    let (mut turns, mut recent) = (0.0, Vec::new());
    for k in 1..samples.len() {
        let duration = motion.times[k] - motion.times[k - 1];
        let before = median(&recent);
        let mut more = motion.turns(k, before.unwrap_or(0.0));
        if duration > longest {
            let after = motion.rate_from(k, before.unwrap_or(0.0));
            if let Some(after) = after {
                let before = before.unwrap_or(after);
                more = motion.turns(k, 0.5 * (before + after));
                if (after - before).abs() * duration > MAX_DIFFERENCE_PERIODS * period {
                    unknown.push((motion.times[k - 1], motion.times[k]));
                }
            }
        }
        turns += more;
        values[samples[k]] += period * turns;
        remember(&mut recent, motion.rate(k, more));
    }
    UnwrappedColumn { values, unknown }
}

struct WrappedColumn {
    times: Vec<f64>,
    values: Vec<f64>,
    period: f64,
    longest_step: f64,
}

impl WrappedColumn {
    /// Returns the number of periods to add at a sample, relative to the preceding sample, for a given rate.
    fn turns(&self, k: usize, rate: f64) -> f64 {
        let expected = rate * (self.times[k] - self.times[k - 1]);
        ((expected - (self.values[k] - self.values[k - 1])) / self.period).round()
    }

    fn rate(&self, k: usize, turns: f64) -> f64 {
        let step = self.values[k] - self.values[k - 1] + self.period * turns;
        step / (self.times[k] - self.times[k - 1])
    }

    /// Returns the rate after a sample, near `guess`, if steps without a gap follow.
    fn rate_from(&self, first: usize, guess: f64) -> Option<f64> {
        let mut rates = Vec::new();
        for k in first + 1..self.times.len().min(first + 1 + RECENT_STEPS) {
            if self.times[k] - self.times[k - 1] > self.longest_step {
                break;
            }
            let expected = median(&rates).unwrap_or(guess);
            rates.push(self.rate(k, self.turns(k, expected)));
        }
        median(&rates)
    }
}

fn remember(recent: &mut Vec<f64>, rate: f64) {
    if recent.len() == RECENT_STEPS {
        recent.remove(0);
    }
    recent.push(rate);
}

pub(crate) fn median(numbers: &[f64]) -> Option<f64> {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::unwrap_values;

    const STEP: f64 = 0.01;

    fn times(count: usize) -> Vec<f64> {
        (0..count).map(|k| STEP * k as f64).collect()
    }

    /// Returns values in 0..360, rounded to the counts of a sensor with 4096 per turn.
    fn wrap_values(motion: &[f64]) -> Vec<f64> {
        let counter = |v: &f64| (v.rem_euclid(360.0) / 360.0 * 4096.0).floor() / 4096.0 * 360.0;
        motion.iter().map(counter).collect()
    }

    /// Returns the largest error of an unwrapped motion that starts between 0 and 360 degrees.
    fn error(motion: &[f64], column: &[f64]) -> f64 {
        let found = unwrap_values(&times(motion.len()), column, 360.0);
        assert!(found.unknown.is_empty(), "{:?}", found.unknown);
        let pairs = motion.iter().zip(&found.values);
        let known = pairs.filter(|(_, value)| value.is_finite());
        known.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn unwrapping_recovers_fast_motion() {
        for per_sample in [0.3, 90.0, 175.0] {
            for sign in [1.0, -1.0] {
                let motion: Vec<f64> = (0..500)
                    .map(|k| 10.0 + sign * per_sample * f64::from(k))
                    .collect();
                assert!(error(&motion, &wrap_values(&motion)) < 0.1, "{per_sample}");
            }
        }
        // The angle accelerates from rest to 270 degrees per sample.
        let faster: Vec<f64> = (0..900).map(|k| 0.15 * f64::from(k * k)).collect();
        assert!(error(&faster, &wrap_values(&faster)) < 0.1);
    }

    #[test]
    fn unwrapping_tolerates_noise_and_outliers() {
        let motion: Vec<f64> = (0..600)
            .map(|k| 360.0 + 30.0 * (0.05 * f64::from(k)).sin() + 5.0 * (2.7 * f64::from(k)).sin())
            .collect();
        let mut column = wrap_values(&motion);
        column[300] = 170.0;
        let found = unwrap_values(&times(600), &column, 360.0);
        let offset = motion[0] - found.values[0];
        for k in (0..600).filter(|k| *k != 300) {
            assert!((motion[k] - found.values[k] - offset).abs() < 0.2, "{k}");
        }
    }

    #[test]
    fn turns_in_gap_follow_from_speed_or_are_unknown() {
        let motion: Vec<f64> = (0..400).map(|k| 5.0 + 100.0 * f64::from(k)).collect();
        let mut column = wrap_values(&motion);
        column[200..230].fill(f64::NAN);
        assert!(error(&motion, &column) < 0.1);
        // The motion is twice as fast after the gap.
        let motion: Vec<f64> = (0..400)
            .map(|k| 50.0 * f64::from(k.min(215)) + 100.0 * f64::from((k - 215).max(0)))
            .collect();
        let mut column = wrap_values(&motion);
        column[200..230].fill(f64::NAN);
        let found = unwrap_values(&times(400), &column, 360.0);
        assert_eq!(found.unknown.len(), 1);
        let (from, to) = found.unknown[0];
        assert!((from - 1.99).abs() < 1e-9 && (to - 2.3).abs() < 1e-9);
    }
}
