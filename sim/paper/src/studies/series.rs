//! Recorded series of a case in the quantities of the paper, and their amplitudes.

use super::arm::ConversionFactors;

/// Indices of the coordinates in the state. The modes follow the coordinates, and the rates follow the modes.
pub(super) const X_SP: usize = 0;
pub(super) const X_PR: usize = 1;
pub(super) const X_C: usize = 2;
pub(super) const FIRST_MODE: usize = 3;

/// Amplitude of a quantity over the record, in its unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Amplitude {
    /// Greatest magnitude.
    pub largest: f64,
    /// Mean.
    pub mean: f64,
    /// RMS about the mean.
    pub rms: f64,
    /// Difference between the greatest and the least value.
    pub span: f64,
}

impl Amplitude {
    /// Computes the amplitude of a series.
    pub fn from_values(values: &[f64]) -> Self {
        let count = values.len().max(1) as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Self {
            largest: high.abs().max(low.abs()),
            mean,
            rms: (squares / count).sqrt(),
            span: high - low,
        }
    }
}

/// Recorded series, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// Times, s.
    pub times: Vec<f64>,
    /// Deflection of the sun-planet mesh, m.
    pub x_sp: Vec<f64>,
    /// Deflection of the planet-ring mesh, m.
    pub x_pr: Vec<f64>,
    /// l dtheta, the part of the transmission error in the positioning error, m.
    pub transmission: Vec<f64>,
    /// dr = w(l, t), the deflection of the arm at its end, m.
    pub dr: Vec<f64>,
    /// f_la of Eq. (24) as printed, m.
    pub f_la: Vec<f64>,
    /// q_i, m, one series per mode.
    pub modal: Vec<Vec<f64>>,
}

impl Record {
    pub(super) fn from_states(
        times: &[f64],
        states: &[Vec<f64>],
        lengths: &ConversionFactors,
    ) -> Self {
        let column = |index: usize| -> Vec<f64> {
            let values = states.iter().map(|state| state.get(index).copied());
            values.map(Option::unwrap_or_default).collect()
        };
        let (x_sp, x_pr) = (column(X_SP), column(X_PR));
        let modes = FIRST_MODE..FIRST_MODE + lengths.tip_amplitudes.len();
        let modal: Vec<Vec<f64>> = modes.map(column).collect();
        let transmission: Vec<f64> = x_sp
            .iter()
            .zip(&x_pr)
            .map(|(x_sp, x_pr)| lengths.transmission_factor * (x_sp + x_pr))
            .collect();
        let mut dr = vec![0.0; x_sp.len()];
        for (series, at_tip) in modal.iter().zip(&lengths.tip_amplitudes) {
            for (sum, q) in dr.iter_mut().zip(series) {
                *sum += at_tip * q;
            }
        }
        let f_la = transmission.iter().zip(&dr).map(|(a, b)| a + b).collect();
        Self {
            times: times.to_vec(),
            x_sp,
            x_pr,
            transmission,
            dr,
            f_la,
            modal,
        }
    }
}

pub(super) fn extents(states: &[Vec<f64>]) -> Vec<f64> {
    let width = states.first().map_or(0, Vec::len);
    let mut limits = vec![(f64::INFINITY, f64::NEG_INFINITY); width];
    for state in states {
        for ((low, high), value) in limits.iter_mut().zip(state) {
            *low = low.min(*value);
            *high = high.max(*value);
        }
    }
    limits.iter().map(|(low, high)| high - low).collect()
}
