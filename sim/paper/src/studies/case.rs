//! One case of the paper, measured after its transient: what kind of motion it is, how large
//! the positioning error and its two components are, which mode bends the arm.
//!
//! After the transient a_m has no part in the motion but the speed of rotation: the drive
//! runs free, no force depends on its angle, and in the rotating frame the mean torque is
//! zero. Only for b_m = 0, where the drive accelerates for ever, does a_m load the teeth.

use eomgen_analysis::classify::{Evidence, Verdict};
use eomgen_analysis::modes::{BandPower, TipShares, band_power, tip_shares};
use eomgen_analysis::poincare::Shape;
use eomgen_analysis::spectrum::{Trend, welch, without_harmonics};
use eomgen_sim::piecewise_linear::Propagator;

use super::arm::{Arm, Case, Lengths};
use super::error::StudyError;
use super::kind::{Known, find, is_strong};
use super::neighbours::Neighbours;
use super::run::Run;
use super::series::extents;
pub use super::series::{Amplitude, Record};

/// Forcing periods in a segment of a spectrum: harmonics are then 20 steps apart.
const SEGMENT: usize = 20;
/// From fewer segments, which overlap by half, peaks of noise stand out as lines do.
const FEWEST_SEGMENTS: usize = 8;
/// The band of a natural frequency reaches about this much above and below, by ratio.
const BAND: f64 = 2.5;
/// The least and the most samples per forcing period.
const LEAST_SAMPLES: usize = 64;
const MOST_SAMPLES: usize = 16_384;
/// How many of the drive's time constants J/b_m are waited for. The arm's first mode decays
/// through the motor several times slower than the rotation (some six times, estimated from
/// the power it takes out with the assumed values). From the second mode on the paper's arm,
/// which has no damping of its own, is hardly damped at all: what is left of these modes
/// after minutes makes a motion quasi-periodic that would be periodic in the end.
const TIME_CONSTANTS: f64 = 30.0;

/// How long a case is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Length {
    /// The least and the most forcing periods that are waited for the transient to pass.
    /// Between the two it is 30 time constants J/b_m of the whole drive, with which the arm's
    /// first mode decays too; `Measurement::trend` says whether that was enough.
    pub transient: (usize, usize),
    /// How many forcing periods are recorded then; at least 100, as the 0-1 test needs.
    pub periods: usize,
    /// The least and the most forcing periods that a motion is followed to tell its kind: twice
    /// as many each time, until it is decided. What is recorded does not grow with them. Chaos
    /// that comes and goes has an exponent with an error from some 1000 on.
    pub followed: (usize, usize),
    /// After how many recorded forcing periods a motion is let go whose neighbours part by
    /// more than a factor e per forcing period, three standard errors deducted: such chaos
    /// needs no second witness, and is the dearest to follow. None: never.
    pub strong: Option<usize>,
    /// How many of the arm's modes the spectra shall show, with their bands: that sets the
    /// sampling rate. The variance of a modal coordinate needs no such rate.
    pub modes: usize,
}

impl Length {
    /// For thousands of parameter sets.
    pub const SCREENING: Self = Self {
        transient: (20, 60),
        periods: 100,
        followed: (100, 400),
        strong: Some(30),
        modes: 1,
    };

    /// For the best of these.
    pub const CONFIRMING: Self = Self {
        transient: (100, 300),
        periods: 300,
        followed: (1000, 2000),
        strong: None,
        modes: 1,
    };

    /// For the tables: the 0-1 test from 400 points, spectra with all modes.
    pub const FULL: Self = Self {
        transient: (150, 1000),
        periods: 400,
        followed: (1000, 2000),
        strong: None,
        modes: 4,
    };

    /// Samples per forcing period.
    fn samples(&self, case: &Case, lengths: &Lengths) -> usize {
        let shown = self.modes.min(lengths.natural.len());
        let highest = shown
            .checked_sub(1)
            .and_then(|mode| lengths.natural.get(mode));
        let needed = highest.map_or(0.0, |highest| 2.6 * BAND * highest * case.period());
        (needed as usize).clamp(LEAST_SAMPLES, MOST_SAMPLES)
    }
}

/// A case as measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// What was run.
    pub case: Case,
    /// What speaks for the kind of motion of the gear reducer.
    pub evidence: Evidence,
    /// The kind of motion.
    pub verdict: Verdict,
    /// From how many forcing periods the kind was decided.
    pub periods: usize,
    /// The stroboscopic section: points of x_sp, x_pr and their rates, once per forcing
    /// period; m and m/s.
    pub section: Vec<f64>,
    /// What the section looks like.
    pub shape: Shape,
    /// x_sp, m.
    pub x_sp: Amplitude,
    /// f_la as printed, m.
    pub f_la: Amplitude,
    /// dr - l dtheta, m: dtheta is a lag and dr a lead, so this is the error of the end point.
    pub f_la_signed: Amplitude,
    /// l dtheta, m.
    pub transmission: Amplitude,
    /// dr, m.
    pub dr: Amplitude,
    /// What each mode contributes to the tip; empty for a rigid arm.
    pub shares: TipShares,
    /// The mean square of phi_i(l) q_i faster than the first mode's band, m^2: what vibrates, as
    /// against the deflection that follows the torque quasi-statically.
    pub vibration: Vec<f64>,
    /// The power of dr about the natural frequencies of the clamped arm. Those of the arm on
    /// the closed drive are higher, by 15 % for the first mode, and the bands reach from 0.4
    /// to 2.5 times: it does not matter which are taken. None for a rigid arm and for
    /// samples too few to show the highest mode.
    pub bands: Option<BandPower>,
    /// The logarithm of the ratio of the rms of f_la in the second half of the record to that
    /// in the first: 0 once the transient has passed.
    pub trend: f64,
    /// How long was waited, s.
    pub transient: f64,
    /// Switches per second.
    pub switches: f64,
    /// The series.
    pub record: Record,
}

impl Measurement {
    /// The number, from 1, of the mode that vibrates most at the arm's end.
    pub fn dominant_mode(&self) -> Option<usize> {
        let most = self.vibration.iter().copied().fold(0.0, f64::max);
        let place = self.vibration.iter().position(|power| *power == most);
        place.filter(|_| most > 0.0).map(|mode| mode + 1)
    }

    /// The number, from 1, of the mode whose band of frequencies holds most power of dr.
    pub fn dominant_band(&self) -> Option<usize> {
        let bands = self.bands.as_ref()?;
        bands.dominant().map(|mode| mode + 1)
    }
}

/// Runs and measures a case, from rest at zero.
///
/// # Errors
/// A length that is too short, values that no machine has, switches without end.
pub fn measure(arm: &Arm, case: &Case, length: &Length) -> Result<Measurement, StudyError> {
    if length.periods < 100 || !(case.period() > 0.0 && case.period().is_finite()) {
        return Err(StudyError::Request(
            "expected at least 100 forcing periods of a positive frequency".to_owned(),
        ));
    }
    let lengths = arm.lengths(case);
    let samples = length.samples(case, &lengths);
    let mut propagator = arm.propagator(case)?;
    let waited = waiting(case, length, &lengths);
    let mut run = Run::start(&mut propagator, case, waited, samples)?;
    let mut neighbours = Neighbours::beside(&run, &mut propagator, case, &lengths)?;
    let (recorded, followed) = match length.strong {
        Some(periods) if parts_at_once(&mut neighbours, &mut propagator, case, periods)? => {
            (periods, (periods, periods))
        }
        _ => (length.periods, length.followed),
    };
    run.extend(&mut propagator, recorded)?;
    let record = Record::of(&run.times, &run.states, &lengths);
    let interval = case.period() / samples as f64;
    let segment = SEGMENT * samples;
    let known = Known {
        case,
        extents: &extents(&run.states),
        line_share: line_share(&record.x_sp, interval, samples)?,
    };
    let found = find(&mut neighbours, &mut propagator, &known, followed)?;
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
        x_sp: Amplitude::of(&record.x_sp),
        f_la: Amplitude::of(&record.f_la),
        f_la_signed: Amplitude::of(&signed),
        transmission: Amplitude::of(&record.transmission),
        dr: Amplitude::of(&record.dr),
        shares: tip_shares(&modal, &lengths.at_tip)?,
        vibration: vibration(&record.modal, interval, segment, &lengths)?,
        bands: bands(&record.dr, interval, segment, &lengths)?,
        trend: (Amplitude::of(halves.1).rms / Amplitude::of(halves.0).rms).ln(),
        transient: run.begin,
        switches: run.switches as f64 / (run.end() - run.begin),
        record,
    })
}

/// Whether neighbours part so fast over the first periods that nothing else need be asked.
fn parts_at_once(
    neighbours: &mut Neighbours,
    propagator: &mut Propagator,
    case: &Case,
    periods: usize,
) -> Result<bool, StudyError> {
    neighbours.extend(propagator, periods)?;
    Ok(is_strong(&neighbours.exponent()?, case))
}

/// How many forcing periods are waited.
fn waiting(case: &Case, length: &Length, lengths: &Lengths) -> usize {
    let (least, most) = length.transient;
    let b_m = case.undisclosed.b_m;
    if b_m <= 0.0 {
        return least;
    }
    let time = TIME_CONSTANTS * lengths.inertia / b_m;
    ((time / case.period()).ceil() as usize).clamp(least, most.max(least))
}

/// The share in lines of what x_sp does beside the forcing's harmonics; none from a record so
/// short that noise would pass for lines.
fn line_share(x_sp: &[f64], interval: f64, samples: usize) -> Result<Option<f64>, StudyError> {
    if x_sp.len() < FEWEST_SEGMENTS * SEGMENT * samples / 2 {
        return Ok(None);
    }
    let Some(rest) = without_harmonics(x_sp, samples) else {
        return Ok(None);
    };
    Ok(welch(&rest, interval, SEGMENT * samples, Trend::Mean)?.line_share())
}

/// Power above the first band, whichever frequency it is seen at: what is faster than half
/// the sampling rate is folded down and keeps its power, all but the small part of it that
/// falls below the band.
fn vibration(
    modal: &[Vec<f64>],
    interval: f64,
    segment: usize,
    lengths: &Lengths,
) -> Result<Vec<f64>, StudyError> {
    let low = lengths.natural.first().map_or(0.0, |first| first / BAND);
    let mut powers = Vec::with_capacity(modal.len());
    for (series, at_tip) in modal.iter().zip(&lengths.at_tip) {
        let spectrum = welch(series, interval, segment, Trend::Mean)?;
        powers.push(at_tip * at_tip * spectrum.power_between(low, f64::INFINITY));
    }
    Ok(powers)
}

fn bands(
    dr: &[f64],
    interval: f64,
    segment: usize,
    lengths: &Lengths,
) -> Result<Option<BandPower>, StudyError> {
    match lengths.natural.last() {
        Some(highest) if 2.0 * BAND * highest * interval < 1.0 => {
            let spectrum = welch(dr, interval, segment, Trend::Mean)?;
            Ok(Some(band_power(&spectrum, &lengths.natural)?))
        }
        _ => Ok(None),
    }
}
