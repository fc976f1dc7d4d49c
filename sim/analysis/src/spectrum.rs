//! Power spectral densities, by Welch's method or of a whole series, and how much of the power
//! lies in lines.
//!
//! P. D. Welch, "The use of fast Fourier transform for the estimation of power spectra",
//! IEEE Trans. Audio Electroacoust. 15 (1967) 70-73.

use realfft::RealFftPlanner;

use super::error::{AnalysisError, check, check_positive};

/// A one-sided power spectral density.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PowerSpectrum {
    /// Frequencies from 0 to half the sampling rate, evenly spaced, Hz.
    pub frequency: Vec<f64>,
    /// As many densities, in the square of the series' unit per Hz.
    pub density: Vec<f64>,
}

/// What is taken off each segment before it is windowed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trend {
    /// The mean of the segment.
    #[default]
    Mean,
    /// The straight line of least squares: for an angle that drifts while it vibrates.
    Line,
}

/// Half the width of a line under the Hann window, in steps of frequency.
const LINE_HALF_WIDTH: usize = 2;
/// How far to both sides the background of a line is looked for, in steps of frequency.
const BACKGROUND_REACH: usize = 24;
/// A smaller share of the power than this is that of rounding, a thousandth of a millionth of
/// the amplitude.
const ROUNDING: f64 = 1e-18;
/// How far a line stands out of its background. A density averaged over eight segments or
/// more exceeds four times its median once in some 10^6 values if the signal is noise.
const PROMINENCE: f64 = 20.0;

/// The density of `values`, sampled every `interval` s, from segments of `segment` samples.
///
/// Segments overlap by half; what fills no further segment at the end is left out. Each has
/// its `trend` removed, giving x_n, and is windowed with Hann's w_n = sin^2(pi n/N). With
/// X_k the discrete Fourier transform of w_n x_n, N = `segment` and h = `interval`,
///
/// ```text
/// S_k = c_k h |X_k|^2 / sum_n w_n^2,     f_k = k/(N h),     k = 0 .. N/2
/// ```
///
/// where c_k = 2, but 1 at zero and at half the sampling rate; the mean over the segments is
/// returned. Parseval's theorem then holds to rounding, with df = 1/(N h):
///
/// ```text
/// sum_k S_k df = mean over segments of  sum_n (w_n x_n)^2 / sum_n w_n^2
/// ```
///
/// which is the variance, weighted with the square of the window.
///
/// # Errors
///
/// Fewer values than one segment, a segment of fewer than 8, values that are not finite, an
/// interval that is not positive.
pub fn welch(
    values: &[f64],
    interval: f64,
    segment: usize,
    trend: Trend,
) -> Result<PowerSpectrum, AnalysisError> {
    check_positive(interval, "the sampling interval")?;
    check(values, segment.max(8))?;
    if segment < 8 {
        return Err(AnalysisError::TooFew {
            needed: 8,
            given: segment,
        });
    }
    let window = hann(segment);
    let weight: f64 = window.iter().map(|weight| weight * weight).sum();
    let pieces = values.windows(segment).step_by(segment / 2);
    let windowed = pieces.map(|piece| {
        let mut windowed = without_trend(piece, trend);
        for (value, weight) in windowed.iter_mut().zip(&window) {
            *value *= weight;
        }
        windowed
    });
    Ok(one_sided(windowed, segment, interval, weight))
}

/// The density of the whole of `values`, sampled every `interval` s, neither windowed nor with
/// a trend removed: [`welch`]'s S_k of one segment with w_n = 1.
///
/// # Errors
///
/// Fewer than 8 values, values that are not finite, an interval that is not positive.
pub fn periodogram(values: &[f64], interval: f64) -> Result<PowerSpectrum, AnalysisError> {
    check_positive(interval, "the sampling interval")?;
    check(values, 8)?;
    let length = values.len();
    let whole = std::iter::once(values.to_vec());
    Ok(one_sided(whole, length, interval, length as f64))
}

/// The mean density of segments of `length` samples, whose window's squares sum to `weight`.
fn one_sided(
    segments: impl Iterator<Item = Vec<f64>>,
    length: usize,
    interval: f64,
    weight: f64,
) -> PowerSpectrum {
    let factor = 2.0 * interval / weight;
    let mut density = mean_power(segments, length);
    let last = density.len() - 1;
    for (k, value) in density.iter_mut().enumerate() {
        let is_alone = k == 0 || (k == last && length.is_multiple_of(2));
        *value *= if is_alone { 0.5 * factor } else { factor };
    }
    let step = 1.0 / (length as f64 * interval);
    PowerSpectrum {
        frequency: (0..density.len()).map(|k| k as f64 * step).collect(),
        density,
    }
}

/// The mean of |X_k|^2 over segments of `length` samples.
fn mean_power(segments: impl Iterator<Item = Vec<f64>>, length: usize) -> Vec<f64> {
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let mut transformed = transform.make_output_vec();
    let mut scratch = transform.make_scratch_vec();
    let mut power = vec![0.0; transformed.len()];
    let mut count = 0_u32;
    for mut segment in segments {
        // Fails only for buffers of wrong lengths, and these are the plan's own.
        let _ = transform.process_with_scratch(&mut segment, &mut transformed, &mut scratch);
        for (sum, value) in power.iter_mut().zip(&transformed) {
            *sum += value.norm_sqr();
        }
        count += 1;
    }
    for sum in &mut power {
        *sum /= f64::from(count);
    }
    power
}

/// What is left of a series when the mean over all periods of `period` samples is taken off
/// it: the forcing's line and all of its harmonics, which any forced motion has, chaos
/// included. Samples after the last whole period are left out. None if nothing is left but
/// rounding, for a motion that repeats with the forcing, or if there is no whole period.
pub fn without_harmonics(values: &[f64], period: usize) -> Option<Vec<f64>> {
    let periods = values.len().checked_div(period)?;
    let mut repeated = vec![0.0; period];
    for cycle in values.chunks_exact(period) {
        for (sum, value) in repeated.iter_mut().zip(cycle) {
            *sum += value / periods as f64;
        }
    }
    let cycles = values.chunks_exact(period);
    let rest = cycles.flat_map(|cycle| cycle.iter().zip(&repeated).map(|(x, mean)| x - mean));
    let rest: Vec<f64> = rest.collect();
    let power = |series: &[f64]| series.iter().map(|x| x * x).sum::<f64>();
    let average = super::error::mean(values);
    let varying: Vec<f64> = values.iter().map(|value| value - average).collect();
    (power(&rest) > ROUNDING * power(&varying)).then_some(rest)
}

impl PowerSpectrum {
    /// The step from one frequency to the next, Hz; 0 if there are fewer than two.
    pub fn resolution(&self) -> f64 {
        match *self.frequency.as_slice() {
            [first, second, ..] => second - first,
            _ => 0.0,
        }
    }

    /// The power at frequencies in [`low`, `high`), in the square of the series' unit.
    pub fn power_between(&self, low: f64, high: f64) -> f64 {
        let inside = self.frequency.iter().zip(&self.density);
        inside
            .filter(|(frequency, _)| (low..high).contains(*frequency))
            .map(|(_, density)| density)
            .sum::<f64>()
            * self.resolution()
    }

    /// The power at all frequencies, in the square of the series' unit.
    pub fn power(&self) -> f64 {
        self.density.iter().sum::<f64>() * self.resolution()
    }

    /// The share of the power that lies in discrete lines, between 0 and 1; none if there is
    /// no power at all.
    ///
    /// A line is a density that is the greatest within two steps of frequency (half the main
    /// lobe of the window) and at least 20 times the median density within 24 steps; its
    /// power is that of these five densities above that median. Periodic and quasi-periodic
    /// motion has a share near 1, chaos less. Lines closer than some ten steps are taken for
    /// a continuum: the segments must be long enough. With fewer than some eight segments
    /// peaks of noise may be taken for lines: the series must be long enough.
    pub fn line_share(&self) -> Option<f64> {
        let total: f64 = self.density.iter().sum();
        if !(total > 0.0 && total.is_finite()) {
            return None;
        }
        let lines = (0..self.density.len()).filter_map(|k| self.line_density(k));
        // From 0 on: the sum of nothing is -0.
        let sum = lines.fold(0.0, |sum, line| sum + line);
        Some((sum / total).clamp(0.0, 1.0))
    }

    /// The sum of the densities of the line at `k` above its background, if there is one.
    fn line_density(&self, k: usize) -> Option<f64> {
        let peak = *self.density.get(k)?;
        let around = |reach: usize| {
            let end = (k + reach + 1).min(self.density.len());
            self.density.get(k.saturating_sub(reach)..end)
        };
        let lobe = around(LINE_HALF_WIDTH)?;
        // Of equal neighbours only the first is a peak.
        let before = self.density.get(k.saturating_sub(LINE_HALF_WIDTH)..k)?;
        if lobe.iter().any(|other| *other > peak) || before.contains(&peak) {
            return None;
        }
        let mut background = around(BACKGROUND_REACH)?.to_vec();
        let middle = background.len() / 2;
        let (_, median, _) = background.select_nth_unstable_by(middle, f64::total_cmp);
        let median = *median;
        (peak > PROMINENCE * median).then(|| lobe.iter().map(|d| (d - median).max(0.0)).sum())
    }
}

/// Hann's window without the zero at its end, so that windows overlapping by half sum to 1.
fn hann(length: usize) -> Vec<f64> {
    let angle = std::f64::consts::PI / length as f64;
    (0..length)
        .map(|n| (angle * n as f64).sin().powi(2))
        .collect()
}

fn without_trend(piece: &[f64], trend: Trend) -> Vec<f64> {
    let mean = super::error::mean(piece);
    let middle = (piece.len() as f64 - 1.0) / 2.0;
    let offset = |n: usize| n as f64 - middle;
    let slope = match trend {
        Trend::Mean => 0.0,
        Trend::Line => {
            let with = piece
                .iter()
                .enumerate()
                .map(|(n, x)| offset(n) * (x - mean));
            let square = (0..piece.len()).map(|n| offset(n).powi(2));
            with.sum::<f64>() / square.sum::<f64>()
        }
    };
    let line = |n: usize| mean + slope * offset(n);
    piece.iter().enumerate().map(|(n, x)| x - line(n)).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::maps::noise;

    fn sine(amplitude: f64, frequency: f64, interval: f64, count: usize) -> Vec<f64> {
        (0..count)
            .map(|n| amplitude * (TAU * frequency * n as f64 * interval).sin())
            .collect()
    }

    #[test]
    fn a_sine_has_half_its_squared_amplitude_at_its_frequency() -> Result<(), AnalysisError> {
        // 125 Hz lies on a frequency of the estimate, 126.3 Hz between two.
        for frequency in [125.0, 126.3] {
            let values = sine(3e-5, frequency, 1e-3, 4096);
            let spectrum = welch(&values, 1e-3, 512, Trend::Mean)?;
            let top = (0..spectrum.density.len())
                .max_by(|a, b| spectrum.density[*a].total_cmp(&spectrum.density[*b]))
                .unwrap();
            let resolution = spectrum.resolution();
            assert!((spectrum.frequency[top] - frequency).abs() <= 0.5 * resolution);
            let power = spectrum.power_between(frequency - 8.0, frequency + 8.0);
            // Sidelobes of the window beyond four steps hold less than 1e-3 of the power.
            assert!(
                (power / (0.5 * 3e-5_f64.powi(2)) - 1.0).abs() < 1e-3,
                "{power}"
            );
            assert!(spectrum.line_share().unwrap() > 0.99);
        }
        Ok(())
    }

    #[test]
    fn a_periodogram_holds_the_mean_square() -> Result<(), AnalysisError> {
        for count in [8, 999, 1000] {
            let values = noise(count);
            let mean_square = values.iter().map(|x| x * x).sum::<f64>() / count as f64;
            let spectrum = periodogram(&values, 1e-2)?;
            assert!((spectrum.power() / mean_square - 1.0).abs() < 1e-12);
        }
        assert!(periodogram(&[0.0; 7], 1e-2).is_err());
        assert!(periodogram(&[0.0; 8], 0.0).is_err());
        Ok(())
    }

    #[test]
    fn white_noise_has_twice_its_variance_times_the_interval_everywhere()
    -> Result<(), AnalysisError> {
        let (interval, count, segment) = (1e-2, 1 << 17, 256);
        // Even on [-1, 1): variance 1/3.
        let spectrum = welch(&noise(count), interval, segment, Trend::Mean)?;
        let level = 2.0 * interval / 3.0;
        // 1023 overlapping segments leave a scatter of 1.06/sqrt(1023), 3.3 %: five of these.
        for (k, density) in spectrum.density.iter().enumerate().take(128).skip(3) {
            assert!((density / level - 1.0).abs() < 0.17, "{k}: {density}");
        }
        assert!(spectrum.line_share().unwrap() < 1e-3);
        Ok(())
    }

    #[test]
    fn the_density_sums_to_the_variance_of_the_windowed_signal() -> Result<(), AnalysisError> {
        // One segment, odd and even lengths: nothing is left to chance.
        for segment in [8, 9, 100, 101] {
            let values = noise(segment);
            let mean = values.iter().sum::<f64>() / segment as f64;
            let weight = |n: usize| 0.5 - 0.5 * (TAU * n as f64 / segment as f64).cos();
            let squares = |n: usize| (weight(n) * (values[n] - mean)).powi(2);
            let variance = (0..segment).map(squares).sum::<f64>()
                / (0..segment).map(|n| weight(n).powi(2)).sum::<f64>();
            let spectrum = welch(&values, 0.25, segment, Trend::Mean)?;
            // Rounding of sums over 100 values.
            assert!(
                (spectrum.power() / variance - 1.0).abs() < 1e-12,
                "{segment}"
            );
        }
        Ok(())
    }

    #[test]
    fn a_drift_does_not_hide_a_vibration() -> Result<(), AnalysisError> {
        let vibration = sine(1e-3, 50.0, 1e-3, 4096);
        let drifting: Vec<f64> = vibration
            .iter()
            .enumerate()
            .map(|(n, x)| x + 5.0 * n as f64)
            .collect();
        let spectrum = welch(&drifting, 1e-3, 512, Trend::Line)?;
        // A line fitted to a segment of 26 periods takes less than 1 % of the sine with it.
        assert!(
            (spectrum.power() / 0.5e-6 - 1.0).abs() < 1e-2,
            "{}",
            spectrum.power()
        );
        Ok(())
    }

    #[test]
    fn half_noise_leaves_half_the_power_in_the_line() -> Result<(), AnalysisError> {
        let (count, amplitude) = (1 << 16, (2.0_f64 / 3.0).sqrt());
        let mixed: Vec<f64> = noise(count)
            .iter()
            .zip(sine(amplitude, 100.0, 1e-3, count))
            .map(|(noise, sine)| noise + sine)
            .collect();
        let share = welch(&mixed, 1e-3, 1000, Trend::Mean)?.line_share();
        // 130 segments: the noise under the line is subtracted to within a per cent.
        assert!((share.unwrap() - 0.5).abs() < 0.02, "{share:?}");
        Ok(())
    }

    #[test]
    fn a_strong_forcing_does_not_hide_that_the_rest_is_noise() -> Result<(), AnalysisError> {
        let (count, period) = (1 << 16, 50);
        // Harmonics a hundred times as strong as what else moves, noise or another line.
        let forced = |rest: &[f64]| -> Vec<f64> {
            let harmonics = |n: usize| {
                let angle = TAU * n as f64 / period as f64;
                60.0 * angle.sin() + 25.0 * (3.0 * angle).cos()
            };
            rest.iter()
                .enumerate()
                .map(|(n, x)| x + harmonics(n))
                .collect()
        };
        let share = |values: &[f64]| -> Result<Option<f64>, AnalysisError> {
            Ok(welch(values, 1e-3, 20 * period, Trend::Mean)?.line_share())
        };
        let noisy = forced(&noise(count));
        assert!(share(&noisy)?.unwrap() > 0.999, "the forcing's lines");
        let rest = without_harmonics(&noisy, period).unwrap();
        assert!(share(&rest)?.unwrap() < 0.01);
        let lines = forced(&sine(1.0, 7.3, 1e-3, count));
        let rest = without_harmonics(&lines, period).unwrap();
        assert!(share(&rest)?.unwrap() > 0.99);
        assert_eq!(without_harmonics(&forced(&vec![0.0; count]), period), None);
        assert_eq!(without_harmonics(&[1.0; 5], 0), None);
        assert_eq!(without_harmonics(&[1.0; 5], 6), None);
        Ok(())
    }

    #[test]
    fn what_has_no_spectrum_is_refused() {
        let short = welch(&[0.0; 7], 1.0, 8, Trend::Mean);
        assert_eq!(
            short,
            Err(AnalysisError::TooFew {
                needed: 8,
                given: 7
            })
        );
        assert!(welch(&[0.0; 9], 0.0, 8, Trend::Mean).is_err());
        assert!(welch(&[0.0; 9], 1.0, 0, Trend::Mean).is_err());
        let hole = [0.0, f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(
            welch(&hole, 1.0, 8, Trend::Mean),
            Err(AnalysisError::NotFinite { sample: 1 })
        );
        let silent = welch(&[2.0; 64], 1.0, 16, Trend::Line).map(|s| s.line_share());
        assert_eq!(silent, Ok(None));
    }
}
