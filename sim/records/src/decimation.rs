//! Decimation of samples. Channels first pass a zero-phase low-pass filter, which prevents aliasing. Inputs are
//! replaced by their mean over the time for which they are held.

use std::f64::consts::PI;

/// Frequency at which the low-pass filter halves the amplitude, relative to the new sampling rate.
const RELATIVE_CUT_OFF: f64 = 0.4;

/// Half length of the low-pass filter, in kept samples. With Blackman's window it keeps amplitudes up to three fifths
/// of the new Nyquist frequency within 2e-4; above that frequency less than 2e-4 remains. The ripple of 1e-3 of a
/// Hamming window would exceed the noise of many encoders.
const HALF_LENGTH_SAMPLES: usize = 14;

/// Sum of the magnitudes of filter weights at missing samples above which the result counts as missing. Weights without
/// their counterparts on the other side shift a varying column.
const MAX_MISSING_WEIGHT: f64 = 1e-3;

/// Number of known samples on each side of a gap through which the interpolating polynomial passes.
const GAP_NEIGHBOURS: usize = 2;

#[derive(Clone, Debug)]
pub(crate) struct Decimation {
    factor: usize,
    /// Weights of one half of the symmetric low-pass filter, from its middle on; `None` without a filter.
    low_pass: Option<Vec<f64>>,
}

impl Decimation {
    pub fn new(every: usize, filter: bool) -> Self {
        Self {
            factor: every,
            low_pass: (filter && every > 1).then(|| compute_low_pass_weights(every)),
        }
    }

    pub fn is_idle(&self) -> bool {
        self.factor == 1
    }

    pub fn is_filtered(&self) -> bool {
        self.low_pass.is_some()
    }

    /// Returns the factor by which the filter reduces the standard deviation of white noise.
    pub fn noise_factor(&self) -> f64 {
        let Some(weights) = &self.low_pass else {
            return 1.0;
        };
        let squares = weights.iter().map(|weight| weight * weight);
        (2.0 * squares.sum::<f64>() - weights[0] * weights[0]).sqrt()
    }

    pub fn pick_samples<T: Copy>(&self, column: &[T]) -> Vec<T> {
        column.iter().step_by(self.factor).copied().collect()
    }

    pub fn decimate_measured(&self, column: &[f64]) -> Vec<f64> {
        match &self.low_pass {
            None => self.pick_samples(column),
            Some(weights) => {
                let column = fill_short_gaps(column, self.factor);
                let kept = (0..column.len()).step_by(self.factor);
                kept.map(|sample| filter_sample(&column, sample, weights))
                    .collect()
            }
        }
    }

    /// Returns the first moment of held samples about the middle of their interval, the time between two kept samples.
    /// The length of the interval is the unit of time.
    fn compute_moment(&self, samples: &[f64], mean: f64) -> f64 {
        if samples.len() < self.factor {
            return 0.0;
        }
        let factor = self.factor as f64;
        let arm = |place: usize| (place as f64 + 0.5) / factor - 0.5;
        let known = samples
            .iter()
            .enumerate()
            .filter(|(_, value)| value.is_finite());
        known
            .map(|(place, value)| (value - mean) * arm(place) / factor)
            .sum()
    }

    /// Decimates a held column: returns the means until the next kept sample, corrected so that the whole column keeps the
    /// moments of the impulses about every time. The means alone delay a rising input: the motion of a mass with an input of
    /// N kept samples per period errs by pi^2 / (3 N^2).
    pub fn decimate_held(&self, column: &[f64]) -> Vec<f64> {
        if !self.is_filtered() {
            return self.pick_samples(column);
        }
        let mean = |held: &[f64]| {
            let known = held.iter().filter(|value| value.is_finite());
            let (sum, count) = known.fold((0.0, 0.0), |(s, n), value| (s + value, n + 1.0));
            sum / count
        };
        let mut held: Vec<f64> = column.chunks(self.factor).map(mean).collect();
        let moments = column.chunks(self.factor).zip(&held);
        let moments: Vec<f64> = moments
            .map(|(samples, mean)| self.compute_moment(samples, *mean))
            .collect();
        for (place, moment) in moments.into_iter().enumerate() {
            let last = held.len() - 1;
            let (before, after) = (place.saturating_sub(1), (place + 1).min(last));
            let change = moment / (after - before).max(1) as f64;
            if held[before].is_finite() && held[after].is_finite() {
                held[before] -= change;
                held[after] += change;
            }
        }
        held
    }
}

/// Returns one half of a sinc function in Blackman's window with the sum 1, from its middle on.
fn compute_low_pass_weights(every: usize) -> Vec<f64> {
    let reach = (HALF_LENGTH_SAMPLES * every) as f64;
    let weight = |k: usize| {
        let k = k as f64;
        let phase = 2.0 * PI * RELATIVE_CUT_OFF / every as f64 * k;
        let sinc = if k == 0.0 { 1.0 } else { phase.sin() / phase };
        let turn = PI * k / reach;
        sinc * (0.42 + 0.5 * turn.cos() + 0.08 * (2.0 * turn).cos())
    };
    let weights: Vec<f64> = (0..=HALF_LENGTH_SAMPLES * every).map(weight).collect();
    let sum = 2.0 * weights.iter().sum::<f64>() - weights[0];
    weights.into_iter().map(|weight| weight / sum).collect()
}

/// Returns the filtered column at a sample; the column is continued beyond its ends by point reflection.
fn filter_sample(column: &[f64], sample: usize, weights: &[f64]) -> f64 {
    let last = column.len() - 1;
    let at = |place: isize| match usize::try_from(place) {
        Err(_) => 2.0 * column[0] - column[place.unsigned_abs().min(last)],
        Ok(place) if place > last => 2.0 * column[last] - column[(2 * last).saturating_sub(place)],
        Ok(place) => column[place],
    };
    let (mut sum, mut known, mut missing) = (0.0, 0.0, 0.0);
    let reach = weights.len() as isize - 1;
    for k in -reach..=reach {
        let weight = weights[k.unsigned_abs()];
        let value = at(sample as isize + k);
        if value.is_finite() {
            sum += weight * value;
            known += weight;
        } else {
            missing += weight.abs();
        }
    }
    if missing > MAX_MISSING_WEIGHT {
        return f64::NAN;
    }
    sum / known
}

/// Fills gaps of at most `longest` samples with the polynomial through the nearest known samples.
fn fill_short_gaps(column: &[f64], longest: usize) -> Vec<f64> {
    let mut filled = column.to_vec();
    let is_known = |place: &usize| column[*place].is_finite();
    let mut begin = 0;
    while begin < column.len() {
        let end = (begin..column.len()).find(is_known).unwrap_or(column.len());
        if (1..=longest).contains(&(end - begin)) {
            let before = (0..begin).rev().filter(is_known).take(GAP_NEIGHBOURS);
            let after = (end..column.len()).filter(is_known).take(GAP_NEIGHBOURS);
            let known: Vec<usize> = before.chain(after).collect();
            for (value, place) in filled[begin..end].iter_mut().zip(begin..end) {
                *value = interpolate(column, &known, place);
            }
        }
        begin = end + 1;
    }
    filled
}

/// Returns the value at `place` of Lagrange's polynomial through the samples `known`; NaN without samples.
fn interpolate(column: &[f64], known: &[usize], place: usize) -> f64 {
    if known.is_empty() {
        return f64::NAN;
    }
    let distance = |a: usize, b: usize| a as f64 - b as f64;
    let terms = known.iter().map(|own| {
        let others = known.iter().filter(|other| *other != own);
        let factors = others.map(|other| distance(place, *other) / distance(*own, *other));
        column[*own] * factors.product::<f64>()
    });
    terms.sum()
}

#[cfg(test)]
mod tests {
    use super::Decimation;

    /// Returns a wave with ten samples per kept sample; `frequency` is in periods per kept sample.
    fn wave(frequency: f64) -> Vec<f64> {
        let phase = |k: usize| 2.0 * std::f64::consts::PI * frequency * k as f64 / 10.0;
        (0..4000).map(|k| (phase(k) + 0.3).sin()).collect()
    }

    /// Returns the largest difference of two columns, excluding their ends.
    fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
        let middle = a.len() / 10..a.len() - a.len() / 10;
        let pairs = a[middle.clone()].iter().zip(&b[middle]);
        pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn low_pass_has_no_delay_and_prevents_aliasing() {
        let kept = Decimation::new(10, true);
        for frequency in [0.01, 0.1, 0.3] {
            let slow = wave(frequency);
            let passed =
                largest_difference(&kept.decimate_measured(&slow), &kept.pick_samples(&slow));
            assert!(passed < 3e-4, "{frequency}: {passed}");
        }
        for frequency in [0.5, 0.7, 1.1, 3.0] {
            let fast = kept.decimate_measured(&wave(frequency));
            let left = largest_difference(&fast, &vec![0.0; fast.len()]);
            assert!(left < 3e-4, "{frequency}: {left}");
        }
        let plain = Decimation::new(10, false);
        let folded = plain.decimate_measured(&wave(1.1));
        assert!(largest_difference(&folded, &vec![0.0; folded.len()]) > 0.9);
    }

    #[test]
    fn low_pass_keeps_lines_and_bridges_missing_samples() {
        let mut line: Vec<f64> = (0..1000).map(|k| 3.0 + 0.5 * f64::from(k)).collect();
        let kept = Decimation::new(7, true);
        let pairs = |column: &[f64]| {
            largest_difference(&kept.decimate_measured(column), &kept.pick_samples(column))
        };
        assert!(pairs(&line) < 1e-9);
        for place in [0, 14, 15, 350, 998, 999] {
            line[place] = f64::NAN;
        }
        line[620..627].fill(f64::NAN);
        let filtered = kept.decimate_measured(&line);
        for (found, sample) in filtered.iter().zip((0..1000).step_by(7)) {
            let right = 3.0 + 0.5 * f64::from(sample);
            assert!((found - right).abs() < 1e-9, "{sample}: {found}");
        }
        line[200..500].fill(f64::NAN);
        let filtered = kept.decimate_measured(&line);
        assert!(filtered[50].is_nan() && filtered[28].is_nan() && filtered[86].is_finite());
    }

    #[test]
    fn missing_samples_do_not_shift_a_wave() {
        for share in [3, 10, 29] {
            let kept = Decimation::new(10, true);
            let whole = wave(0.1);
            let mut column = whole.clone();
            column
                .iter_mut()
                .skip(2)
                .step_by(share)
                .for_each(|value| *value = f64::NAN);
            let filtered = kept.decimate_measured(&column);
            let right = kept.decimate_measured(&whole);
            assert!(largest_difference(&filtered, &right) < 1e-5, "{share}");
        }
    }

    #[test]
    fn low_pass_reduces_white_noise_by_stated_factor() {
        let mut state = 1u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let noise: Vec<f64> = (0..200_000).map(|_| uniform()).collect();
        let rms = |column: &[f64]| {
            (column.iter().map(|v| v * v).sum::<f64>() / column.len() as f64).sqrt()
        };
        let kept = Decimation::new(10, true);
        let shrunk = rms(&kept.decimate_measured(&noise)) / rms(&noise);
        assert!(
            (shrunk / kept.noise_factor() - 1.0).abs() < 0.02,
            "{shrunk}"
        );
        assert!(
            (kept.noise_factor() - 0.28).abs() < 0.02,
            "{}",
            kept.noise_factor()
        );
    }

    #[test]
    fn decimated_input_keeps_its_impulse_and_moment() {
        let kept = Decimation::new(4, true);
        let held = kept.decimate_held(&[1.0, 1.0, 1.0, 1.0, 8.0, f64::NAN, 8.0, 8.0, 5.0]);
        assert_eq!(held, [1.0, 8.0, 5.0]);
        let column = [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 6.0, 0.0, 0.0, 0.0, 0.0];
        let held = kept.decimate_held(&column);
        let moment = |held: &[f64], step: f64| -> (f64, f64) {
            let samples = held.iter().enumerate();
            samples.fold((0.0, 0.0), |(sum, moment), (k, value)| {
                (
                    sum + step * value,
                    moment + step * value * step * (k as f64 + 0.5),
                )
            })
        };
        let (right, found) = (moment(&column, 1.0), moment(&held, 4.0));
        assert!(
            (right.0 - found.0).abs() < 1e-12 && (right.1 - found.1).abs() < 1e-12,
            "{right:?} {found:?}"
        );
    }

    /// Integrates the motion of a unit mass under a held force; returns the position after each step.
    fn move_mass(forces: &[f64], step: f64) -> Vec<f64> {
        let (mut x, mut v) = (0.0, 0.0);
        let moved = forces.iter().map(|force| {
            x += step * (v + 0.5 * step * force);
            v += step * force;
            x
        });
        moved.collect()
    }

    #[test]
    fn decimated_input_moves_a_mass_like_the_whole() {
        // The wave has 40 kept samples per period.
        let force = wave(1.0 / 40.0);
        let kept = Decimation::new(10, true);
        let right = move_mass(&force, 0.1);
        let right: Vec<f64> = right.iter().skip(9).step_by(10).copied().collect();
        let missed = |held: &[f64]| {
            // A linear error comes from the initial state; the second difference removes it.
            let found = move_mass(held, 1.0);
            let errors: Vec<f64> = found.iter().zip(&right).map(|(a, b)| a - b).collect();
            let bends = errors
                .windows(41)
                .map(|part| part[0] - 2.0 * part[20] + part[40]);
            bends.map(f64::abs).fold(0.0, f64::max) / 4.0
        };
        let means: Vec<f64> = force
            .chunks(10)
            .map(|part| part.iter().sum::<f64>() / 10.0)
            .collect();
        let amplitude = (40.0 / (2.0 * std::f64::consts::PI)).powi(2);
        let expected = amplitude * std::f64::consts::PI.powi(2) / (3.0 * 1600.0);
        let of_means = missed(&means);
        assert!(
            (of_means / expected - 1.0).abs() < 0.1,
            "{of_means} {expected}"
        );
        let found = missed(&kept.decimate_held(&force));
        assert!(found < 0.02 * of_means, "{found} {of_means}");
    }
}
