//! Dominant mode of a flexible body, by its contribution to the tip deflection and by frequency bands.

use super::error::{AnalysisError, check_values, mean};
use super::spectrum::PowerSpectrum;

/// Contribution of each mode to the tip deflection, modes counted from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct TipShares {
    /// Mean square of phi_i(l) q_i, in the squared unit.
    pub mean_square: Vec<f64>,
    /// Variance of phi_i(l) q_i, which excludes the static deflection.
    pub variance: Vec<f64>,
}

/// Power of a deflection in the bands around natural frequencies, counted from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct BandPower {
    /// Power in the band of each natural frequency, in the squared unit.
    pub power: Vec<f64>,
    /// Power below the first band: the quasi-static response to the forcing.
    pub below: f64,
    /// Power above the last band.
    pub above: f64,
}

impl TipShares {
    /// Returns the mode with the largest mean square, or `None` if all are 0.
    pub fn dominant(&self) -> Option<usize> {
        greatest(&self.mean_square)
    }
}

impl BandPower {
    /// Returns the index of the natural frequency with the most power in its band, or `None` if no band has
    /// power.
    pub fn dominant(&self) -> Option<usize> {
        greatest(&self.power)
    }
}

/// Computes the contribution of each modal coordinate to the tip: `coordinates[i]` are samples of
/// q_i, and `at_tip[i]` is phi_i(l).
///
/// The sum of the mean squares differs from the mean square of the tip, because products of correlated modes
/// contribute as well.
///
/// # Errors
///
/// Different numbers of shapes and coordinates, coordinates of different lengths, no samples,
/// values that are not finite.
pub fn tip_shares(coordinates: &[&[f64]], at_tip: &[f64]) -> Result<TipShares, AnalysisError> {
    check_values(at_tip, 0)?;
    check_length(coordinates.len(), at_tip.len())?;
    let samples = coordinates.first().map_or(0, |first| first.len());
    let mut shares = TipShares {
        mean_square: Vec::with_capacity(at_tip.len()),
        variance: Vec::with_capacity(at_tip.len()),
    };
    for (series, shape) in coordinates.iter().zip(at_tip) {
        check_values(series, 1)?;
        check_length(samples, series.len())?;
        let average = mean(series);
        let square = |about: f64| {
            let squares = series.iter().map(|q| (shape * (q - about)).powi(2));
            squares.sum::<f64>() / samples as f64
        };
        shares.mean_square.push(square(0.0));
        shares.variance.push(square(average));
    }
    Ok(shares)
}

/// Computes the power of a deflection in the bands of ascending `natural` frequencies (Hz).
///
/// Neighbouring bands meet at the geometric mean of their frequencies. The first and the last band extend
/// equally far, by ratio, to both sides of their frequencies. A single band is an octave wide.
///
/// # Errors
///
/// No natural frequency, a frequency that is not positive or not above the previous one.
pub fn band_power(spectrum: &PowerSpectrum, natural: &[f64]) -> Result<BandPower, AnalysisError> {
    check_values(natural, 1)?;
    let edges = edges(natural)?;
    let bands = edges.windows(2).filter_map(|pair| match *pair {
        [low, high] => Some(spectrum.power_between(low, high)),
        _ => None,
    });
    let first = edges.first().copied().unwrap_or_default();
    let last = edges.last().copied().unwrap_or_default();
    Ok(BandPower {
        power: bands.collect(),
        below: spectrum.power_between(0.0, first),
        above: spectrum.power_between(last, f64::INFINITY),
    })
}

/// Returns the limits of the bands, one more than there are natural frequencies.
fn edges(natural: &[f64]) -> Result<Vec<f64>, AnalysisError> {
    let mut ratios = Vec::with_capacity(natural.len());
    let mut below = 0.0;
    for (index, frequency) in natural.iter().enumerate() {
        if *frequency <= below {
            return Err(AnalysisError::NotAscending { index });
        }
        if index > 0 {
            ratios.push((frequency / below).sqrt());
        }
        below = *frequency;
    }
    let octave = 2_f64.sqrt();
    let first = ratios.first().copied().unwrap_or(octave);
    let last = ratios.last().copied().unwrap_or(octave);
    let lowest = natural.first().map(|frequency| frequency / first);
    let upper = natural.iter().zip(ratios.iter().chain([&last]));
    Ok(lowest
        .into_iter()
        .chain(upper.map(|(frequency, ratio)| frequency * ratio))
        .collect())
}

fn check_length(expected: usize, given: usize) -> Result<(), AnalysisError> {
    if expected == given {
        Ok(())
    } else {
        Err(AnalysisError::LengthMismatch { expected, given })
    }
}

/// Returns the index of the greatest value, the first of equal ones, or `None` if no value is
/// positive.
fn greatest(values: &[f64]) -> Option<usize> {
    let positive = values.iter().enumerate().filter(|(_, value)| **value > 0.0);
    // Descending order, because `max_by` returns the last of equal maxima.
    positive
        .rev()
        .max_by(|a, b| a.1.total_cmp(b.1))
        .map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::spectrum::{Trend, welch};

    /// Returns `mean + amplitude sin(2 pi f t)` over whole periods, with 4096 samples per second.
    fn wave(mean: f64, amplitude: f64, frequency: f64) -> Vec<f64> {
        (0..4096)
            .map(|n| mean + amplitude * (TAU * frequency * f64::from(n) / 4096.0).sin())
            .collect()
    }

    #[test]
    fn variance_excludes_the_static_deflection() -> Result<(), AnalysisError> {
        let (q_1, q_2) = (wave(1e-3, 1e-5, 12.0), wave(0.0, 3e-5, 75.0));
        let shares = tip_shares(&[&q_1, &q_2], &[2.0, -2.0])?;
        assert_eq!(shares.dominant(), Some(0));
        assert_eq!(greatest(&shares.variance), Some(1));
        // Mean square of a + b sin: a^2 + b^2/2; sums over whole periods round to 1e-12.
        let expected = [4.0 * (1e-6 + 0.5e-10), 4.0 * 4.5e-10];
        for (found, expected) in shares.mean_square.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-11);
        }
        assert!((shares.variance[0] / 2e-10 - 1.0).abs() < 1e-9);
        Ok(())
    }

    #[test]
    fn bands_meet_at_geometric_means() -> Result<(), AnalysisError> {
        assert_eq!(edges(&[10.0, 40.0, 160.0])?, [5.0, 20.0, 80.0, 320.0]);
        let single = edges(&[100.0])?;
        assert!((single[1] / single[0] - 2.0).abs() < 1e-12);
        Ok(())
    }

    #[test]
    fn band_power_separates_vibrations() -> Result<(), AnalysisError> {
        // Natural frequencies of a clamped beam (1 : 6.27 : 17.5), with forcing far below.
        let natural = [20.0, 125.4, 350.0];
        let parts = [
            wave(0.0, 1.0, 3.0),
            wave(0.0, 0.5, 22.0),
            wave(0.0, 2.0, 340.0),
        ];
        let sum: Vec<f64> = (0..4096)
            .map(|n| parts.iter().map(|p| p[n]).sum())
            .collect();
        let spectrum = welch(&sum, 1.0 / 4096.0, 4096, Trend::Mean)?;
        let bands = band_power(&spectrum, &natural)?;
        assert_eq!(bands.dominant(), Some(2));
        // With whole periods in the segment, the window leaks to two neighbours only.
        assert!((bands.power[0] - 0.125).abs() < 1e-9 && bands.power[1] < 1e-9);
        assert!((bands.power[2] - 2.0).abs() < 1e-9 && (bands.below - 0.5).abs() < 1e-9);
        assert!(bands.above < 1e-9);
        Ok(())
    }

    #[test]
    fn mismatched_lengths_are_rejected() {
        assert!(tip_shares(&[&[1.0]], &[1.0, 1.0]).is_err());
        assert!(tip_shares(&[&[1.0], &[1.0, 2.0]], &[1.0, 1.0]).is_err());
        assert!(tip_shares(&[&[]], &[1.0]).is_err());
        assert_eq!(
            tip_shares(&[], &[]).map(|shares| shares.dominant()),
            Ok(None)
        );
        assert_eq!(
            edges(&[2.0, 2.0]),
            Err(AnalysisError::NotAscending { index: 1 })
        );
        assert!(edges(&[-1.0]).is_err());
    }
}
