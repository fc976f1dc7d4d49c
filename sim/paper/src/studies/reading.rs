//! Numbers of a measured case that the claims use, without time series.

use std::f64::consts::{PI, TAU};
use std::fmt;

use eomgen_analysis::classify::{
    Evidence, MAX_HIDDEN_GROWTH_PER_PERIOD, Motion, SIGNIFICANT_STANDARD_ERRORS,
};

use super::arm::{Case, UndisclosedParameters};
use super::case::{Amplitude, Measurement};
use super::kind::is_strong_growth;

/// Forcing frequency of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Forcing {
    /// omega = 5 pi rad/s.
    FivePi,
    /// omega = 10 pi rad/s.
    TenPi,
}

/// Case of the paper, independent of the undisclosed values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct CaseKey {
    /// Modal truncation order; 0 is the rigid arm.
    pub order: usize,
    /// Forcing frequency.
    pub forcing: Forcing,
    /// Half the backlash, um.
    pub micrometres: u32,
}

impl Forcing {
    /// Returns the frequency in rad/s.
    pub fn omega(self) -> f64 {
        match self {
            Self::FivePi => 5.0 * PI,
            Self::TenPi => 10.0 * PI,
        }
    }
}

impl CaseKey {
    /// Creates a case of the flexible arm with the order of the paper.
    pub const fn flexible(forcing: Forcing, micrometres: u32) -> Self {
        Self {
            order: 4,
            forcing,
            micrometres,
        }
    }

    /// Returns the case with the given undisclosed values.
    pub fn case(self, undisclosed: UndisclosedParameters) -> Case {
        Case {
            order: self.order,
            backlash: f64::from(self.micrometres) * 1e-6,
            omega: self.forcing.omega(),
            undisclosed,
        }
    }
}

impl fmt::Display for CaseKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let arm = match self.order {
            0 => "rigid arm".to_owned(),
            order => format!("S = {order}"),
        };
        let omega = match self.forcing {
            Forcing::FivePi => "5 pi",
            Forcing::TenPi => "10 pi",
        };
        write!(f, "{arm}, {omega}, b = {} um", self.micrometres)
    }
}

/// Kind of motion in the sense of the claims.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Periodic or quasi-periodic motion, which the paper does not distinguish.
    Regular,
    /// Chaotic motion.
    Chaotic,
    /// The kind of motion is undecided.
    Unknown,
}

/// Numbers of a case that the claims use.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Kind of motion.
    pub kind: Kind,
    /// True for quasi-periodic motion in the strict sense: regular, without a period.
    pub is_strictly_quasi_periodic: bool,
    /// Sentence with the kind and its numbers.
    pub sentence: String,
    /// f_la as printed in Eq. (24), m.
    pub f_la: Amplitude,
    /// dr - l dtheta, m.
    pub f_la_signed: Amplitude,
    /// l dtheta, m.
    pub transmission: Amplitude,
    /// dr, m.
    pub dr: Amplitude,
    /// Mean square of each mode's vibration at the tip, m^2.
    pub vibration: Vec<f64>,
}

impl Reading {
    /// Extracts the numbers of a measurement.
    ///
    /// If the verdict of [`eomgen_analysis::classify`] is undecided, the exponent decides. The motion is regular if the
    /// exponent is not positive and its error cannot hide growth of more than 0.1 per forcing period. It is chaotic if
    /// it grows by more than a factor e per forcing period and no period was found. Unless the record is much longer
    /// than the beat, the 0-1 test mistakes the slow beat of a nearly undamped mode with the forcing for diffusion.
    pub fn from_measurement(measurement: &Measurement) -> Self {
        let motion = measurement.verdict.motion;
        let kind = match motion {
            Motion::Periodic { .. } | Motion::QuasiPeriodic => Kind::Regular,
            Motion::Chaotic => Kind::Chaotic,
            Motion::Undecided if does_not_grow(&measurement.evidence) => Kind::Regular,
            Motion::Undecided if grows_fast(measurement) => Kind::Chaotic,
            Motion::Undecided => Kind::Unknown,
        };
        let note = match (motion, kind) {
            (Motion::Undecided, Kind::Regular) => {
                " Counted as regular: the exponent is not positive."
            }
            (Motion::Undecided, Kind::Chaotic) => " Counted as chaotic: the exponent is large.",
            _ => "",
        };
        Self {
            kind,
            is_strictly_quasi_periodic: kind == Kind::Regular
                && measurement.evidence.period.is_none(),
            sentence: format!("{}{note}", measurement.verdict.sentence),
            f_la: measurement.f_la,
            f_la_signed: measurement.f_la_signed,
            transmission: measurement.transmission,
            dr: measurement.dr,
            vibration: measurement.vibration.clone(),
        }
    }

    /// Returns the number, from 1, of the mode with the largest vibration.
    pub fn dominant_mode(&self) -> Option<usize> {
        let most = self.vibration.iter().copied().fold(0.0, f64::max);
        let index = self.vibration.iter().position(|power| *power == most);
        index.filter(|_| most > 0.0).map(|mode| mode + 1)
    }
}

/// Returns true if the growth is fast enough to decide without the 0-1 test.
fn grows_fast(measurement: &Measurement) -> bool {
    let Evidence {
        exponent, period, ..
    } = &measurement.evidence;
    let case = &measurement.case;
    period.is_none() && exponent.is_some_and(|exponent| is_strong_growth(&exponent, case))
}

/// Returns true if the exponent is not positive within a small error.
fn does_not_grow(evidence: &Evidence) -> bool {
    let Some(exponent) = evidence.exponent else {
        return false;
    };
    let error = SIGNIFICANT_STANDARD_ERRORS * exponent.standard_error;
    let bound = MAX_HIDDEN_GROWTH_PER_PERIOD * evidence.forcing / TAU;
    exponent.value <= error && exponent.value + error <= bound
}
