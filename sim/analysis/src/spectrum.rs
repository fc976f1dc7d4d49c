//! Power spectral densities, by Welch's method or of a whole series, and the share of spectral
//! lines.
//!
//! P. D. Welch, "The use of fast Fourier transform for the estimation of power spectra", IEEE
//! Trans. Audio Electroacoust. 15 (1967) 70-73.

use realfft::RealFftPlanner;

use super::error::{AnalysisError, check_positive, check_values};

/// One-sided power spectral density.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PowerSpectrum {
    /// Frequencies from 0 to half the sampling rate, evenly spaced, Hz.
    pub frequency: Vec<f64>,
    /// Densities at these frequencies, in the squared unit of the series per Hz.
    pub density: Vec<f64>,
}

/// Trend removed from each segment before the window is applied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trend {
    /// Mean of the segment.
    #[default]
    Mean,
    /// Straight line of least squares, for an angle that drifts while it vibrates.
    Line,
}

/// Half-width of a spectral line under the Hann window, in frequency steps.
const LINE_HALF_WIDTH: usize = 2;
/// Half-width of the background of a line, in frequency steps.
const BACKGROUND_REACH: usize = 24;
/// Largest share of the power that counts as rounding: 1e-9 of the amplitude, squared.
const MAX_ROUNDING_POWER_SHARE: f64 = 1e-18;
/// Smallest ratio of a line to its background. A density of noise averaged over eight or more segments exceeds
/// four times its median once in about 10^6 values.
const MIN_PEAK_OVER_BACKGROUND: f64 = 20.0;

/// Estimates the density of `values`, sampled every `interval` s, from segments of `segment`
/// samples.
///
/// Segments overlap by half; an incomplete last segment is omitted. Each segment without its
/// `trend`, x_n, is multiplied by Hann's window w_n = sin^2(pi n/N). With X_k the discrete Fourier
/// transform of w_n x_n, N = `segment` and h = `interval`,
///
/// ```text
/// S_k = c_k h |X_k|^2 / sum_n w_n^2,     f_k = k/(N h),     k = 0 .. N/2
/// ```
///
/// and c_k = 2, but c_k = 1 at zero and at half the sampling rate. The result is the mean over the
/// segments. Parseval's theorem then holds to rounding, with df = 1/(N h):
///
/// ```text
/// sum_k S_k df = mean over segments of  sum_n (w_n x_n)^2 / sum_n w_n^2
/// ```
///
/// This is the variance weighted with the squared window.
///
/// # Errors
///
/// Fewer values than one segment, a segment of fewer than 8 values, values that are not finite, an
/// interval that is not positive.
pub fn welch(
    values: &[f64],
    interval: f64,
    segment: usize,
    trend: Trend,
) -> Result<PowerSpectrum, AnalysisError> {
    check_positive(interval, "the sampling interval")?;
    check_values(values, segment.max(8))?;
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
        let mut windowed = subtract_trend(piece, trend);
        for (value, weight) in windowed.iter_mut().zip(&window) {
            *value *= weight;
        }
        windowed
    });
    Ok(one_sided(windowed, segment, interval, weight))
}

/// Estimates the density of all `values`, sampled every `interval` s, without window and with its
/// trend: S_k of [`welch`] for one segment with w_n = 1.
///
/// # Errors
///
/// Fewer than 8 values, values that are not finite, an interval that is not positive.
pub fn periodogram(values: &[f64], interval: f64) -> Result<PowerSpectrum, AnalysisError> {
    check_positive(interval, "the sampling interval")?;
    check_values(values, 8)?;
    let length = values.len();
    let whole = std::iter::once(values.to_vec());
    Ok(one_sided(whole, length, interval, length as f64))
}

/// Computes the mean density of segments of `length` samples. `weight` is the sum of the squared
/// window.
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

/// Computes the mean of |X_k|^2 over segments of `length` samples.
fn mean_power(segments: impl Iterator<Item = Vec<f64>>, length: usize) -> Vec<f64> {
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let mut transformed = transform.make_output_vec();
    let mut scratch = transform.make_scratch_vec();
    let mut power = vec![0.0; transformed.len()];
    let mut count = 0_u32;
    for mut segment in segments {
        // Fails only for buffers of wrong length, and these come from the plan.
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

/// Subtracts the mean over all periods of `period` samples: the forcing line and its harmonics, which every
/// forced motion contains. Samples after the last whole period are omitted. Returns `None` if only rounding
/// remains, as for a motion with the forcing period, or if there is no whole period.
pub fn subtract_harmonics(values: &[f64], period: usize) -> Option<Vec<f64>> {
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
    (power(&rest) > MAX_ROUNDING_POWER_SHARE * power(&varying)).then_some(rest)
}

impl PowerSpectrum {
    /// Returns the frequency step, Hz; 0 with fewer than two frequencies.
    pub fn resolution(&self) -> f64 {
        match *self.frequency.as_slice() {
            [first, second, ..] => second - first,
            _ => 0.0,
        }
    }

    /// Returns the power at frequencies in [`low`, `high`), in the squared unit of the series.
    pub fn power_between(&self, low: f64, high: f64) -> f64 {
        let inside = self.frequency.iter().zip(&self.density);
        inside
            .filter(|(frequency, _)| (low..high).contains(*frequency))
            .map(|(_, density)| density)
            .sum::<f64>()
            * self.resolution()
    }

    /// Returns the power at all frequencies, in the squared unit of the series.
    pub fn power(&self) -> f64 {
        self.density.iter().sum::<f64>() * self.resolution()
    }

    /// Returns the share of the power in spectral lines, between 0 and 1, or `None` without power.
    ///
    /// A line is a density that is the largest within two frequency steps (half the main lobe of the window)
    /// and at least 20 times the median density within 24 steps. Its power is the power of these five densities
    /// above the median. Periodic and quasi-periodic motions have a share near 1, chaotic motions less. Lines
    /// closer than about ten steps count as a continuum, so segments must be long enough. With fewer than about
    /// eight segments, peaks of noise may count as lines.
    pub fn line_share(&self) -> Option<f64> {
        let total: f64 = self.density.iter().sum();
        if !(total > 0.0 && total.is_finite()) {
            return None;
        }
        let lines = (0..self.density.len()).filter_map(|k| self.line_density(k));
        // The fold starts at 0, because the sum of an empty iterator is -0.
        let sum = lines.fold(0.0, |sum, line| sum + line);
        Some((sum / total).clamp(0.0, 1.0))
    }

    /// Returns the sum of the densities of the line at `k` above its background, if there is a
    /// line.
    fn line_density(&self, k: usize) -> Option<f64> {
        let peak = *self.density.get(k)?;
        let around = |reach: usize| {
            let end = (k + reach + 1).min(self.density.len());
            self.density.get(k.saturating_sub(reach)..end)
        };
        let lobe = around(LINE_HALF_WIDTH)?;
        // Among equal neighbours only the first is a peak.
        let before = self.density.get(k.saturating_sub(LINE_HALF_WIDTH)..k)?;
        if lobe.iter().any(|other| *other > peak) || before.contains(&peak) {
            return None;
        }
        let mut background = around(BACKGROUND_REACH)?.to_vec();
        let middle = background.len() / 2;
        let (_, median, _) = background.select_nth_unstable_by(middle, f64::total_cmp);
        let median = *median;
        (peak > MIN_PEAK_OVER_BACKGROUND * median)
            .then(|| lobe.iter().map(|d| (d - median).max(0.0)).sum())
    }
}

/// Returns Hann's window without the zero at its end, so that windows overlapping by half sum to 1.
fn hann(length: usize) -> Vec<f64> {
    let angle = std::f64::consts::PI / length as f64;
    (0..length)
        .map(|n| (angle * n as f64).sin().powi(2))
        .collect()
}

fn subtract_trend(piece: &[f64], trend: Trend) -> Vec<f64> {
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
    fn welch_finds_power_and_frequency_of_a_sine() -> Result<(), AnalysisError> {
        // 125 Hz is a frequency of the estimate, 126.3 Hz is between two.
        for frequency in [125.0, 126.3] {
            let values = sine(3e-5, frequency, 1e-3, 4096);
            let spectrum = welch(&values, 1e-3, 512, Trend::Mean)?;
            let top = (0..spectrum.density.len())
                .max_by(|a, b| spectrum.density[*a].total_cmp(&spectrum.density[*b]))
                .unwrap();
            let resolution = spectrum.resolution();
            assert!((spectrum.frequency[top] - frequency).abs() <= 0.5 * resolution);
            let power = spectrum.power_between(frequency - 8.0, frequency + 8.0);
            // Sidelobes of the window beyond four steps have less than 1e-3 of the power.
            assert!(
                (power / (0.5 * 3e-5_f64.powi(2)) - 1.0).abs() < 1e-3,
                "{power}"
            );
            assert!(spectrum.line_share().unwrap() > 0.99);
        }
        Ok(())
    }

    #[test]
    fn periodogram_sums_to_the_mean_square() -> Result<(), AnalysisError> {
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
    fn white_noise_has_a_flat_density() -> Result<(), AnalysisError> {
        let (interval, count, segment) = (1e-2, 1 << 17, 256);
        // Uniform on [-1, 1): variance 1/3.
        let spectrum = welch(&noise(count), interval, segment, Trend::Mean)?;
        let level = 2.0 * interval / 3.0;
        // The standard deviation of a mean over 1023 overlapping segments is 1.06/sqrt(1023), 3.3 %; the limit
        // is five times this.
        for (k, density) in spectrum.density.iter().enumerate().take(128).skip(3) {
            assert!((density / level - 1.0).abs() < 0.17, "{k}: {density}");
        }
        assert!(spectrum.line_share().unwrap() < 1e-3);
        Ok(())
    }

    #[test]
    fn welch_density_sums_to_the_windowed_variance() -> Result<(), AnalysisError> {
        // One segment of odd or even length, so the result is exact.
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
    fn linear_trend_removal_keeps_a_vibration() -> Result<(), AnalysisError> {
        let vibration = sine(1e-3, 50.0, 1e-3, 4096);
        let drifting: Vec<f64> = vibration
            .iter()
            .enumerate()
            .map(|(n, x)| x + 5.0 * n as f64)
            .collect();
        let spectrum = welch(&drifting, 1e-3, 512, Trend::Line)?;
        // A line fitted to a segment of 26 periods removes less than 1 % of the sine.
        assert!(
            (spectrum.power() / 0.5e-6 - 1.0).abs() < 1e-2,
            "{}",
            spectrum.power()
        );
        Ok(())
    }

    #[test]
    fn line_share_of_half_noise_is_half() -> Result<(), AnalysisError> {
        let (count, amplitude) = (1 << 16, (2.0_f64 / 3.0).sqrt());
        let mixed: Vec<f64> = noise(count)
            .iter()
            .zip(sine(amplitude, 100.0, 1e-3, count))
            .map(|(noise, sine)| noise + sine)
            .collect();
        let share = welch(&mixed, 1e-3, 1000, Trend::Mean)?.line_share();
        // With 130 segments, the noise under the line is subtracted to within 1 %.
        assert!((share.unwrap() - 0.5).abs() < 0.02, "{share:?}");
        Ok(())
    }

    #[test]
    fn removed_harmonics_reveal_noise() -> Result<(), AnalysisError> {
        let (count, period) = (1 << 16, 50);
        // Harmonics a hundred times as strong as the remainder, which is noise or another line.
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
        let rest = subtract_harmonics(&noisy, period).unwrap();
        assert!(share(&rest)?.unwrap() < 0.01);
        let lines = forced(&sine(1.0, 7.3, 1e-3, count));
        let rest = subtract_harmonics(&lines, period).unwrap();
        assert!(share(&rest)?.unwrap() > 0.99);
        assert_eq!(subtract_harmonics(&forced(&vec![0.0; count]), period), None);
        assert_eq!(subtract_harmonics(&[1.0; 5], 0), None);
        assert_eq!(subtract_harmonics(&[1.0; 5], 6), None);
        Ok(())
    }

    #[test]
    fn invalid_series_have_no_spectrum() {
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
