//! Measurement of one case after its transient: kind of motion, positioning error with its two components, and dominant
//! mode.
//!
//! After the transient, a_m affects only the speed of rotation: no force depends on the angle of the drive, and in the
//! rotating frame the mean torque is zero. If b_m = 0, the drive keeps accelerating, and a_m loads the teeth.

use eomgen_analysis::classify::{Evidence, Verdict};
use eomgen_analysis::modes::{BandPower, TipShares, band_power, tip_shares};
use eomgen_analysis::poincare::Shape;
use eomgen_analysis::spectrum::{Trend, subtract_harmonics, welch};
use eomgen_sim::piecewise_linear::Propagator;

use super::arm::{Arm, Case, ConversionFactors};
use super::error::StudyError;
use super::kind::{MotionProperties, classify_motion, is_strong_growth};
use super::neighbours::TangentMotion;
use super::run::Run;
use super::series::extents;
pub use super::series::{Amplitude, Record};

/// Number of forcing periods per segment of a spectrum; harmonics are then 20 frequency steps apart.
const PERIODS_PER_SEGMENT: usize = 20;
/// Smallest number of segments, overlapping by half, for which peaks of noise do not count as spectral lines.
const MIN_SEGMENTS: usize = 8;
/// Approximate ratio of the upper limit of a band to its natural frequency, and of the natural frequency to the lower
/// limit.
const BAND_RATIO: f64 = 2.5;
/// Limits of the number of samples per forcing period.
const MIN_SAMPLES_PER_PERIOD: usize = 64;
const MAX_SAMPLES_PER_PERIOD: usize = 16_384;
/// Length of the transient in time constants J/b_m of the drive. The first mode of the arm decays through the motor
/// about six times more slowly than the rotation (estimated from the extracted power, with the assumed values). From
/// the second mode on, the arm is nearly undamped. Remaining vibrations can make a motion quasi-periodic that would
/// become periodic after minutes.
const TRANSIENT_TIME_CONSTANTS: f64 = 30.0;

/// Lengths of the phases of a run, in forcing periods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunLength {
    /// Limits of the transient. Between the limits it is 30 time constants J/b_m of the drive, which also determine the
    /// decay of the first mode. `Measurement::trend` shows a remaining transient.
    pub transient: (usize, usize),
    /// Number of recorded forcing periods, at least 100 for the 0-1 test.
    pub periods: usize,
    /// Limits of the number of periods used for the classification, which is doubled until the kind of motion is
    /// decided. The record does not grow with it. The exponent of intermittent chaos has a reliable error from about
    /// 1000 periods on.
    pub classified_periods: (usize, usize),
    /// Number of recorded periods after which fast growth ends the classification. Growth is fast if it exceeds a
    /// factor e per period by three standard errors. Such chaos needs no second test and is the most expensive to
    /// simulate. `None` disables this rule.
    pub strong_growth_periods: Option<usize>,
    /// Number of modes whose bands the spectra resolve, which determines the sampling rate. The variance of a modal
    /// coordinate does not need this rate.
    pub modes: usize,
}

impl RunLength {
    /// Lengths for thousands of parameter sets.
    pub const SCREENING: Self = Self {
        transient: (20, 60),
        periods: 100,
        classified_periods: (100, 400),
        strong_growth_periods: Some(30),
        modes: 1,
    };

    /// Lengths for the best parameter sets.
    pub const CONFIRMING: Self = Self {
        transient: (100, 300),
        periods: 300,
        classified_periods: (1000, 2000),
        strong_growth_periods: None,
        modes: 1,
    };

    /// Lengths for tables: 0-1 test with 400 points, spectra with all modes.
    pub const FULL: Self = Self {
        transient: (150, 1000),
        periods: 400,
        classified_periods: (1000, 2000),
        strong_growth_periods: None,
        modes: 4,
    };

    fn samples(&self, case: &Case, lengths: &ConversionFactors) -> usize {
        let shown = self.modes.min(lengths.natural_frequencies.len());
        let highest = shown
            .checked_sub(1)
            .and_then(|mode| lengths.natural_frequencies.get(mode));
        let needed = highest.map_or(0.0, |highest| 2.6 * BAND_RATIO * highest * case.period());
        (needed as usize).clamp(MIN_SAMPLES_PER_PERIOD, MAX_SAMPLES_PER_PERIOD)
    }
}

/// Measured case.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Case of the run.
    pub case: Case,
    /// Evidence for the kind of motion of the reducer.
    pub evidence: Evidence,
    /// Kind of motion.
    pub verdict: Verdict,
    /// Number of forcing periods used for the classification.
    pub periods: usize,
    /// Stroboscopic section: points of x_sp, x_pr and their rates once per forcing period; m and
    /// m/s.
    pub section: Vec<f64>,
    /// Geometric properties of the section.
    pub shape: Shape,
    /// x_sp, m.
    pub x_sp: Amplitude,
    /// f_la as printed in Eq. (24), m.
    pub f_la: Amplitude,
    /// dr - l dtheta, m: the positioning error of the end point. dtheta is a lag and dr a lead, so they have opposite
    /// signs.
    pub f_la_signed: Amplitude,
    /// l dtheta, m.
    pub transmission: Amplitude,
    /// dr, m.
    pub dr: Amplitude,
    /// Contribution of each mode to the tip; empty for a rigid arm.
    pub shares: TipShares,
    /// Mean square of phi_i(l) q_i from the lower limit of the first mode's band on, m^2, which excludes the
    /// quasi-static deflection.
    pub vibration: Vec<f64>,
    /// Power of dr in bands around the natural frequencies of the clamped arm. With closed meshes the first frequency
    /// is 15 % higher, which is small compared with the band from 0.4 to 2.5 times the frequency. `None` for a rigid
    /// arm, or if the samples do not resolve the highest mode.
    pub bands: Option<BandPower>,
    /// Logarithm of the ratio of two RMS values of f_la, in the second and in the first half of the record; 0 without a
    /// remaining transient.
    pub trend: f64,
    /// Length of the transient, s.
    pub transient: f64,
    /// Switches per second.
    pub switches: f64,
    /// Recorded series.
    pub record: Record,
}

impl Measurement {
    /// Returns the number, from 1, of the mode with the largest vibration at the tip.
    pub fn dominant_mode(&self) -> Option<usize> {
        let most = self.vibration.iter().copied().fold(0.0, f64::max);
        let index = self.vibration.iter().position(|power| *power == most);
        index.filter(|_| most > 0.0).map(|mode| mode + 1)
    }

    /// Returns the number, from 1, of the mode whose band has the most power of dr.
    pub fn dominant_band(&self) -> Option<usize> {
        let bands = self.bands.as_ref()?;
        bands.dominant().map(|mode| mode + 1)
    }
}

/// Runs and measures a case, from rest at zero.
///
/// # Errors
/// A length that is too short, inadmissible values, an unbounded number of switches.
pub fn measure(arm: &Arm, case: &Case, length: &RunLength) -> Result<Measurement, StudyError> {
    if length.periods < 100 || !(case.period() > 0.0 && case.period().is_finite()) {
        return Err(StudyError::Request(
            "expected at least 100 forcing periods of a positive frequency".to_owned(),
        ));
    }
    let lengths = arm.lengths(case);
    let samples = length.samples(case, &lengths);
    let mut propagator = arm.propagator(case)?;
    let waited = compute_transient_periods(case, length, &lengths);
    let mut run = Run::start(&mut propagator, case, waited, samples)?;
    let mut neighbours = TangentMotion::start(&run, &mut propagator, case, &lengths)?;
    let (recorded, followed) = match length.strong_growth_periods {
        Some(periods) if grows_fast_at_once(&mut neighbours, &mut propagator, case, periods)? => {
            (periods, (periods, periods))
        }
        _ => (length.periods, length.classified_periods),
    };
    run.extend(&mut propagator, recorded)?;
    let record = Record::from_states(&run.times, &run.states, &lengths);
    let interval = case.period() / samples as f64;
    let segment = PERIODS_PER_SEGMENT * samples;
    let known = MotionProperties {
        case,
        extents: &extents(&run.states),
        line_share: line_share(&record.x_sp, interval, samples)?,
    };
    let found = classify_motion(&mut neighbours, &mut propagator, &known, followed)?;
    let signed = record.dr.iter().zip(&record.transmission);
    let signed: Vec<f64> = signed.map(|(dr, lag)| dr - lag).collect();
    let halves = record.f_la.split_at(record.f_la.len() / 2);
    let modal: Vec<&[f64]> = record.modal.iter().map(Vec::as_slice).collect();
    Ok(Measurement {
        case: *case,
        verdict: found.verdict,
        evidence: found.evidence,
        section: found.section,
        shape: found.shape,
        periods: found.periods,
        x_sp: Amplitude::from_values(&record.x_sp),
        f_la: Amplitude::from_values(&record.f_la),
        f_la_signed: Amplitude::from_values(&signed),
        transmission: Amplitude::from_values(&record.transmission),
        dr: Amplitude::from_values(&record.dr),
        shares: tip_shares(&modal, &lengths.tip_amplitudes)?,
        vibration: compute_vibration(&record.modal, interval, segment, &lengths)?,
        bands: compute_bands(&record.dr, interval, segment, &lengths)?,
        trend: (Amplitude::from_values(halves.1).rms / Amplitude::from_values(halves.0).rms).ln(),
        transient: run.begin,
        switches: run.switches as f64 / (run.end() - run.begin),
        record,
    })
}

/// Returns true if growth over the first periods is fast enough to decide the kind of motion.
fn grows_fast_at_once(
    neighbours: &mut TangentMotion,
    propagator: &mut Propagator,
    case: &Case,
    periods: usize,
) -> Result<bool, StudyError> {
    neighbours.extend(propagator, periods)?;
    Ok(is_strong_growth(&neighbours.exponent()?, case))
}

/// Returns the length of the transient in forcing periods.
fn compute_transient_periods(
    case: &Case,
    length: &RunLength,
    lengths: &ConversionFactors,
) -> usize {
    let (least, most) = length.transient;
    let b_m = case.undisclosed.b_m;
    if b_m <= 0.0 {
        return least;
    }
    let time = TRANSIENT_TIME_CONSTANTS * lengths.inertia / b_m;
    ((time / case.period()).ceil() as usize).clamp(least, most.max(least))
}

/// Returns the fraction of the power of x_sp outside the forcing harmonics that spectral lines have. `None` if the
/// record is so short that noise would count as lines.
fn line_share(x_sp: &[f64], interval: f64, samples: usize) -> Result<Option<f64>, StudyError> {
    if x_sp.len() < MIN_SEGMENTS * PERIODS_PER_SEGMENT * samples / 2 {
        return Ok(None);
    }
    let Some(rest) = subtract_harmonics(x_sp, samples) else {
        return Ok(None);
    };
    Ok(welch(&rest, interval, PERIODS_PER_SEGMENT * samples, Trend::Mean)?.line_share())
}

/// Computes the power from the lower limit of the first mode's band on. Frequencies above half the sampling rate are aliased and keep
/// their power, except for a small part that is aliased below the band.
fn compute_vibration(
    modal: &[Vec<f64>],
    interval: f64,
    segment: usize,
    lengths: &ConversionFactors,
) -> Result<Vec<f64>, StudyError> {
    let low = lengths
        .natural_frequencies
        .first()
        .map_or(0.0, |first| first / BAND_RATIO);
    let mut powers = Vec::with_capacity(modal.len());
    for (series, at_tip) in modal.iter().zip(&lengths.tip_amplitudes) {
        let spectrum = welch(series, interval, segment, Trend::Mean)?;
        powers.push(at_tip * at_tip * spectrum.power_between(low, f64::INFINITY));
    }
    Ok(powers)
}

fn compute_bands(
    dr: &[f64],
    interval: f64,
    segment: usize,
    lengths: &ConversionFactors,
) -> Result<Option<BandPower>, StudyError> {
    match lengths.natural_frequencies.last() {
        Some(highest) if 2.0 * BAND_RATIO * highest * interval < 1.0 => {
            let spectrum = welch(dr, interval, segment, Trend::Mean)?;
            Ok(Some(band_power(&spectrum, &lengths.natural_frequencies)?))
        }
        _ => Ok(None),
    }
}
