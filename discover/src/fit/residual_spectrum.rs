//! Spectrum of the residuals of a fit and its peaks.

use eomgen_analysis::spectrum::{PowerSpectrum, Trend, welch};

use crate::fit::fit_result::Fit;
use crate::fit::residuals::channel_residuals;
use crate::ids::ChannelId;
use crate::model::problem::EstimationProblem;
use crate::thresholds;
use eomgen_records::samples::typical_step;
use eomgen_records::windows::{Window, compared_samples};

/// Minimum number of samples of a window with a spectrum.
const MIN_SAMPLES: usize = 16;

/// Peak of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpectralPeak {
    /// Peak at a line of the spectrum.
    Line(SpectralLine),
    /// Most of the power is below a few periods per window.
    BelowResolution,
}

/// Frequency of a spectral line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralLine {
    /// Frequency, interpolated between the lines of the spectrum, Hz.
    pub frequency: f64,
    /// Distance between the lines of the spectrum, Hz.
    pub resolution: f64,
}

/// Returns the peak frequency of the channel with the largest residual, Hz; `None` if there is no
/// peak.
pub fn find_peak_frequency(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<f64> {
    let sizes = &fit.train.normalised_rms;
    let worst = ChannelId::first(sizes.len()).max_by(|a, b| sizes[*a].total_cmp(&sizes[*b]))?;
    match find_training_peak(problem, fit, worst)? {
        SpectralPeak::Line(line) => Some(line.frequency),
        SpectralPeak::BelowResolution => None,
    }
}

/// Returns the spectral peak of the residuals of a channel on the training records.
pub fn find_training_peak(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    channel: ChannelId,
) -> Option<SpectralPeak> {
    let windows: Vec<(&Window, &[f64])> = problem
        .train
        .windows
        .iter()
        .zip(fit.train.window_residuals.iter().map(Vec::as_slice))
        .collect();
    let (spectrum, count) =
        compute_residual_spectrum(&windows, channel.index(), problem.noise.len())?;
    find_peak(&spectrum, count)
}

/// Returns the residual spectrum of a channel and the number of averaged windows. Each window has
/// its own initial state; therefore its linear trend is removed and its ends are tapered. Windows
/// that are shorter than the longest window are ignored.
pub fn compute_residual_spectrum(
    windows: &[(&Window, &[f64])],
    channel: usize,
    channels: usize,
) -> Option<(PowerSpectrum, usize)> {
    let columns: Vec<Vec<f64>> = windows
        .iter()
        .filter(|(_, residual)| !residual.is_empty())
        .map(|(window, residual)| {
            let column = channel_residuals(window, residual, (channel, channels));
            bridge_gaps(&column[compared_samples(column.len())])
        })
        .collect();
    let length = columns
        .iter()
        .map(Vec::len)
        .max()
        .filter(|length| *length >= MIN_SAMPLES)?;
    let step = typical_step(&windows.first()?.0.times);
    let mut mean = PowerSpectrum::default();
    let mut count = 0;
    for column in columns.iter().filter(|column| column.len() == length) {
        let spectrum = welch(column, step, length, Trend::Line).ok()?;
        match count {
            0 => mean = spectrum,
            _ => (mean.density.iter_mut().zip(&spectrum.density)).for_each(|(sum, d)| *sum += d),
        }
        count += 1;
    }
    mean.density.iter_mut().for_each(|sum| *sum /= count as f64);
    Some((mean, count))
}

/// Returns a column with linearly interpolated missing samples.
fn bridge_gaps(column: &[f64]) -> Vec<f64> {
    let known: Vec<usize> = (0..column.len())
        .filter(|k| column[*k].is_finite())
        .collect();
    let value = |k: usize| {
        let after = known.partition_point(|known| *known < k);
        match (after.checked_sub(1).map(|b| known[b]), known.get(after)) {
            (_, Some(b)) if *b == k => column[k],
            (Some(a), Some(b)) => {
                let part = (k - a) as f64 / (b - a) as f64;
                column[a] + part * (column[*b] - column[a])
            }
            (Some(one), None) => column[one],
            (None, Some(one)) => column[*one],
            (None, None) => 0.0,
        }
    };
    (0..column.len()).map(value).collect()
}

/// Returns the line with the largest density of a spectrum averaged over `windows` windows, if it
/// exceeds the level of white noise. The first lines contain all components with periods longer
/// than a window.
fn find_peak(spectrum: &PowerSpectrum, windows: usize) -> Option<SpectralPeak> {
    let density = &spectrum.density;
    let lines = 1..density.len();
    let peak = lines
        .clone()
        .max_by(|a, b| density[*a].total_cmp(&density[*b]))?;
    // The taper spreads a line over both neighbours.
    let others = lines.filter(|line| line.abs_diff(peak) > 2);
    let (sum, count) = others.fold((0.0, 0.0), |(sum, n), line| (sum + density[line], n + 1.0));
    let expected = 1.0 + thresholds::MIN_SPECTRAL_PEAK_RATIO / (windows as f64).sqrt();
    let stands_out = density[peak] * count > expected * sum && density[peak] > 0.0;
    match peak < thresholds::FIRST_SPECTRAL_LINE {
        _ if !stands_out => None,
        true => Some(SpectralPeak::BelowResolution),
        false => Some(SpectralPeak::Line(interpolate_line(spectrum, peak))),
    }
}

/// Returns the frequency of a sine from the line with the largest density, `peak`, and its larger
/// neighbour. With a Hann window, the ratio r of the two amplitudes gives the distance
/// (2 r - 1)/(r + 1) in line distances.
///
/// T. Grandke, "Interpolation algorithms for discrete Fourier transforms of weighted signals", IEEE
/// Trans. Instrum. Meas. 32 (1983) 350-355.
fn interpolate_line(spectrum: &PowerSpectrum, peak: usize) -> SpectralLine {
    let density = &spectrum.density;
    let resolution = spectrum.frequency[1] - spectrum.frequency[0];
    let after = density.get(peak + 1).copied().unwrap_or(0.0);
    let (side, beside) = match after > density[peak - 1] {
        true => (1.0, after),
        false => (-1.0, density[peak - 1]),
    };
    let ratio = (beside / density[peak]).sqrt();
    let shift = side * (2.0 * ratio - 1.0) / (ratio + 1.0);
    SpectralLine {
        frequency: (peak as f64 + shift) * resolution,
        resolution,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 0.01;

    /// Returns the spectral peak of `count` windows of a residual with `samples` samples each.
    fn find_peak_of(
        samples: usize,
        count: usize,
        of: impl Fn(f64, f64) -> f64,
    ) -> Option<SpectralPeak> {
        let time = |k: usize| STEP * k as f64;
        let windows: Vec<(Window, Vec<f64>)> = (0..count)
            .map(|number| {
                let first = number * samples;
                let times: Vec<f64> = (first..first + samples).map(time).collect();
                let residual = times.iter().map(|t| of(*t, *t - times[0])).collect();
                let window = Window {
                    record: 0,
                    first,
                    measured: vec![0.0; samples],
                    times,
                    follows: None,
                };
                (window, residual)
            })
            .collect();
        let pairs: Vec<(&Window, &[f64])> = windows
            .iter()
            .map(|(window, residual)| (window, residual.as_slice()))
            .collect();
        let (spectrum, count) = compute_residual_spectrum(&pairs, 0, 1)?;
        find_peak(&spectrum, count)
    }

    fn noise(t: f64) -> f64 {
        2.0 * ((t * 1298.98).sin() * 43_758.545).fract().abs() - 1.0
    }

    #[test]
    fn drift_is_not_a_spectral_line() {
        for samples in [50, 100, 200] {
            // The residual of each window starts at 0 and drifts, as if driven by a slow force.
            let drift = |t: f64, inside: f64| (0.5 * t).sin() * inside * inside + 1e-3 * noise(t);
            assert_eq!(
                find_peak_of(samples, 12, drift),
                Some(SpectralPeak::BelowResolution),
                "{samples}"
            );
        }
    }

    fn find_line(samples: usize, count: usize, of: impl Fn(f64, f64) -> f64) -> SpectralLine {
        match find_peak_of(samples, count, of) {
            Some(SpectralPeak::Line(line)) => line,
            other => panic!("{samples} samples: {other:?}"),
        }
    }

    #[test]
    fn line_is_found_in_noise_and_drift_but_not_in_noise_alone() {
        let line =
            |t: f64, inside: f64| (std::f64::consts::TAU * 7.0 * t).sin() + 0.3 * inside + noise(t);
        for samples in [100, 200, 400] {
            let found = find_line(samples, 8, line);
            assert!(found.resolution < 1.2 / (STEP * samples as f64));
            assert!(
                (found.frequency - 7.0).abs() < 0.2 * found.resolution,
                "{found:?}"
            );
        }
        for count in [1, 8, 40] {
            assert_eq!(find_peak_of(200, count, |t, _| noise(t)), None, "{count}");
        }
    }

    #[test]
    fn frequency_between_spectral_lines_is_interpolated() {
        for periods in [3.4, 3.5, 4.0, 5.25, 11.7, 30.49] {
            let resolution = 1.0 / (STEP * 200.0);
            let frequency = periods * resolution;
            let sine = |t: f64, _: f64| (std::f64::consts::TAU * frequency * t + 0.4).cos();
            let found = find_line(200, 8, sine).frequency;
            assert!(
                (found - frequency).abs() < 0.1 * resolution,
                "{periods} periods: {found} Hz instead of {frequency} Hz"
            );
        }
    }
}
