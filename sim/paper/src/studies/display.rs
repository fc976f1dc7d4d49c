//! Densely sampled series and spectra of a case, for figures. [`super::case`](mod@super::case) has
//! the measurements.

use eomgen_analysis::spectrum::{PowerSpectrum, Trend, welch};
use eomgen_sim::inputs::HeldInputs;

use super::arm::{Arm, Case};
use super::case::Record;
use super::error::StudyError;
use super::series::{FIRST_MODE, X_SP};

/// Sampling rate, Hz: twice the minimum for the 5 kHz vibration of the meshes.
const SAMPLING_RATE_HZ: f64 = 20_480.0;
/// Recorded time for spectra, s: a whole number of forcing periods.
const RECORDED_S: f64 = 40.0;
/// Number of forcing periods per segment of a spectrum, which averages at least 19 segments.
const PERIODS_PER_SEGMENT: usize = 10;
/// Length of the time histories in figures, s: 5 or 10 forcing periods.
pub(super) const FIGURE_WINDOW_S: f64 = 2.0;
/// Number of components of a point of the section.
const SECTION_COMPONENTS: usize = 4;
/// Band of the spectra, Hz: from below the forcing to above the meshes.
pub(super) const FIGURE_BAND_HZ: (f64, f64) = (1.0, 1e4);

/// Case sampled after its transient.
#[derive(Clone, Debug)]
pub struct SampledCase {
    /// Case of the run.
    pub case: Case,
    /// Natural frequencies of the machine with both meshes in contact, Hz.
    pub natural: Vec<f64>,
    /// Series over the time window of the figures; times from the start at rest.
    pub history: Record,
    /// Rate of x_sp over the same window, m/s.
    pub x_sp_dot: Vec<f64>,
    /// Stroboscopic section: points of x_sp, x_pr and their rates once per forcing period; m and m/s. Empty if no
    /// section was taken.
    pub section: Vec<f64>,
    /// Spectrum of x_sp over the band of the figures, m^2/Hz.
    pub x_sp: PowerSpectrum,
    /// Spectrum of f_la, m^2/Hz.
    pub f_la: PowerSpectrum,
    /// Spectrum of dr, m^2/Hz.
    pub dr: PowerSpectrum,
}

impl SampledCase {
    /// Simulates a case from rest at zero and records it from the time `transient` (s) on.
    ///
    /// # Errors
    /// Inadmissible values, an unbounded number of switches.
    pub fn sample(arm: &Arm, case: &Case, transient: f64) -> Result<Self, StudyError> {
        let per_period = samples_per_period(case);
        let step = case.period() / per_period;
        let periods = (RECORDED_S / case.period()).round();
        let times = even_times(transient, step, (periods * per_period) as usize);
        let (record, x_sp_dot) = sample_with_rate(arm, case, &times)?;
        let shown = (FIGURE_WINDOW_S / step).ceil() as usize + 1;
        let segment = PERIODS_PER_SEGMENT * per_period as usize;
        let spectrum = |values: &[f64]| -> Result<PowerSpectrum, StudyError> {
            Ok(in_band(welch(values, step, segment, Trend::Mean)?))
        };
        Ok(Self {
            case: *case,
            natural: arm.closed_mesh_frequencies(case)?,
            x_sp: spectrum(&record.x_sp)?,
            f_la: spectrum(&record.f_la)?,
            dr: spectrum(&record.dr)?,
            history: first_samples(record, shown),
            x_sp_dot: x_sp_dot.into_iter().take(shown).collect(),
            section: Vec::new(),
        })
    }
}

impl SampledCase {
    /// Returns one component of all points of the section: x_sp, x_pr, or their rates.
    pub(super) fn extract_section_column(&self, index: usize) -> Vec<f64> {
        let points = self.section.chunks_exact(SECTION_COMPONENTS);
        points
            .filter_map(|point| point.get(index).copied())
            .collect()
    }

    pub(super) fn per_period(&self) -> usize {
        samples_per_period(&self.case) as usize
    }
}

fn samples_per_period(case: &Case) -> f64 {
    (SAMPLING_RATE_HZ * case.period()).round()
}

pub(super) fn even_times(begin: f64, step: f64, steps: usize) -> Vec<f64> {
    (0..=steps).map(|n| begin + n as f64 * step).collect()
}

/// Simulates a case from rest at zero and returns its series at the given times, s.
pub(super) fn sample_series(arm: &Arm, case: &Case, times: &[f64]) -> Result<Record, StudyError> {
    Ok(sample_with_rate(arm, case, times)?.0)
}

/// Returns the series and the rate of x_sp, m/s.
fn sample_with_rate(
    arm: &Arm,
    case: &Case,
    times: &[f64],
) -> Result<(Record, Vec<f64>), StudyError> {
    let mut propagator = arm.propagator(case)?;
    let end = times.last().copied().unwrap_or_default();
    let initial = vec![0.0; propagator.state_count()];
    let none = HeldInputs::zero(0);
    let trajectory = propagator.simulate(&initial, (0.0, end), times, &none, &mut |_| {})?;
    let record = Record::from_states(times, &trajectory.states, &arm.lengths(case));
    let rate = FIRST_MODE + case.order + X_SP;
    let rates = trajectory.states.iter();
    let rates = rates.map(|state| state.get(rate).copied().unwrap_or_default());
    Ok((record, rates.collect()))
}

fn in_band(spectrum: PowerSpectrum) -> PowerSpectrum {
    let pairs = spectrum.frequency.into_iter().zip(spectrum.density);
    let (frequency, density) = pairs
        .filter(|(frequency, _)| (FIGURE_BAND_HZ.0..=FIGURE_BAND_HZ.1).contains(frequency))
        .unzip();
    PowerSpectrum { frequency, density }
}

fn first_samples(mut record: Record, count: usize) -> Record {
    let series = [
        &mut record.times,
        &mut record.x_sp,
        &mut record.x_pr,
        &mut record.transmission,
        &mut record.dr,
        &mut record.f_la,
    ];
    for values in series.into_iter().chain(&mut record.modal) {
        values.truncate(count);
    }
    record
}
