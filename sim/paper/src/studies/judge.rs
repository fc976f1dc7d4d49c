//! Whether a claim holds, from the readings of its cases, with its evidence.

use std::collections::BTreeMap;

use super::claims::{Claim, Rule};
use super::reading::{Key, Kind, Reading};

/// The readings of a set of cases.
pub type Readings = BTreeMap<Key, Reading>;

/// A step back by so much still counts as growth: the extremes of a chaotic record scatter.
const FORGIVEN: f64 = 0.01;
/// What must have been gained in all for a growth.
const GAINED: f64 = 0.05;
/// The largest change by a factor that is little.
const LITTLE: f64 = 1.5;
/// The largest difference between truncation orders that is little.
const CONVERGED: f64 = 0.02;

/// Whether a claim holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Holding {
    /// It holds.
    Holds,
    /// It does not.
    Fails,
    /// The evidence does not decide, or there is none.
    Undecided,
}

/// A judged claim.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Judgement {
    /// In the generous reading: any regular motion is taken for the paper's quasi-periodic
    /// one, and the positioning error may have either sign.
    pub holding: Holding,
    /// With quasi-periodic motion and Eq. (24) taken at their word.
    pub strict: Holding,
    /// What was found, for people.
    pub evidence: String,
}

impl Holding {
    /// The letter in tables: H, F or U.
    pub fn letter(self) -> char {
        match self {
            Self::Holds => 'H',
            Self::Fails => 'F',
            Self::Undecided => 'U',
        }
    }

    fn of(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::Fails }
    }

    /// Holds if all do; fails if one does.
    fn all(parts: &[Self]) -> Self {
        if parts.contains(&Self::Fails) {
            Self::Fails
        } else if parts.contains(&Self::Undecided) {
            Self::Undecided
        } else {
            Self::Holds
        }
    }
}

/// Judges a claim. A case without a reading leaves it undecided.
pub fn judge(claim: &Claim, readings: &Readings) -> Judgement {
    let keys = claim.rule.cases();
    let found: Option<Vec<&Reading>> = keys.iter().map(|key| readings.get(key)).collect();
    let Some(found) = found else {
        return Judgement {
            holding: Holding::Undecided,
            strict: Holding::Undecided,
            evidence: "a case could not be measured".to_owned(),
        };
    };
    let (holding, strict) = match claim.rule {
        Rule::Regular(_) => (is(&found, Kind::Regular), is_quasi_periodic(&found)),
        Rule::Chaotic(_) => twice(is(&found, Kind::Chaotic)),
        Rule::Route(_) => (route(&found), strict_route(&found)),
        Rule::ErrorGrows(_) => error_grows(&found),
        Rule::DeflectionDominates(_) => twice(dominates(&found, 1.0)),
        Rule::TransmissionDominates(_) => twice(dominates(&found, -1.0)),
        Rule::ShareGrows(_) => twice(grows(&sizes(&found, |r| r.transmission.span / r.dr.span))),
        Rule::DominantMode(_, mode) => twice(mode_is(&found, mode)),
        Rule::ModeChanges(_) => twice(mode_changes(&found)),
        Rule::DeflectionSteady(_) => twice(is_steady(&found)),
        Rule::FrequencyMatters => twice(frequency_matters(&found)),
        Rule::FlexibilityMatters => twice(differ(&found)),
        Rule::OrderSuffices => twice(agree(&found)),
    };
    Judgement {
        holding,
        strict,
        evidence: super::evidence::evidence(claim.rule, &keys, &found),
    }
}

fn twice(holding: Holding) -> (Holding, Holding) {
    (holding, holding)
}

fn is(found: &[&Reading], kind: Kind) -> Holding {
    match found {
        [reading] if reading.kind != Kind::Unknown => Holding::of(reading.kind == kind),
        _ => Holding::Undecided,
    }
}

fn is_quasi_periodic(found: &[&Reading]) -> Holding {
    match found {
        [reading] if reading.kind != Kind::Unknown => Holding::of(reading.quasi_periodic),
        _ => Holding::Undecided,
    }
}

/// A motion may turn chaotic anywhere between the ends, but not back. Undecided is what could
/// be either with the unknown cases in between.
fn route(found: &[&Reading]) -> Holding {
    let (Some(first), Some(last)) = (found.first(), found.last()) else {
        return Holding::Undecided;
    };
    let kinds: Vec<Kind> = found.iter().map(|reading| reading.kind).collect();
    // Back if chaotic comes anywhere before regular; perhaps back if it may.
    let pairs = |before: &[Kind], after: &[Kind]| {
        let turns = |(place, kind): (usize, &Kind)| {
            before.contains(kind) && kinds.iter().skip(place + 1).any(|k| after.contains(k))
        };
        kinds.iter().enumerate().any(turns)
    };
    let back = if pairs(&[Kind::Chaotic], &[Kind::Regular]) {
        Holding::Fails
    } else if pairs(
        &[Kind::Chaotic, Kind::Unknown],
        &[Kind::Regular, Kind::Unknown],
    ) {
        Holding::Undecided
    } else {
        Holding::Holds
    };
    Holding::all(&[
        is(&[first], Kind::Regular),
        is(&[last], Kind::Chaotic),
        back,
    ])
}

/// With the least backlash the motion must be quasi-periodic in the strict sense.
fn strict_route(found: &[&Reading]) -> Holding {
    let first = found
        .first()
        .map_or(Holding::Undecided, |first| is_quasi_periodic(&[first]));
    Holding::all(&[route(found), first])
}

fn sizes(found: &[&Reading], size: impl Fn(&Reading) -> f64) -> Vec<f64> {
    found.iter().map(|reading| size(reading)).collect()
}

fn grows(sizes: &[f64]) -> Holding {
    let steps = sizes.windows(2).all(|pair| match pair {
        [before, after] => *after >= before * (1.0 - FORGIVEN),
        _ => true,
    });
    match (sizes.first(), sizes.last()) {
        (Some(first), Some(last)) if sizes.iter().all(|size| size.is_finite()) => {
            Holding::of(steps && *last >= first * (1.0 + GAINED))
        }
        _ => Holding::Undecided,
    }
}

/// With either sign of the transmission error, and as printed.
fn error_grows(found: &[&Reading]) -> (Holding, Holding) {
    let printed = grows(&sizes(found, |r| r.f_la.largest));
    let signed = grows(&sizes(found, |r| r.f_la_signed.largest));
    match (printed, signed) {
        (Holding::Holds, _) | (_, Holding::Holds) => (Holding::Holds, printed),
        _ => (printed, printed),
    }
}

/// Whether dr is larger than l dtheta (`sign` 1) or smaller (-1), by both measures.
fn dominates(found: &[&Reading], sign: f64) -> Holding {
    let [reading] = found else {
        return Holding::Undecided;
    };
    let (dr, transmission) = (&reading.dr, &reading.transmission);
    let span = sign * (dr.span - transmission.span);
    let rms = sign * (dr.rms - transmission.rms);
    if span > 0.0 && rms > 0.0 {
        Holding::Holds
    } else if span < 0.0 && rms < 0.0 {
        Holding::Fails
    } else {
        Holding::Undecided
    }
}

fn mode_is(found: &[&Reading], mode: usize) -> Holding {
    match found {
        [reading] => match reading.dominant_mode() {
            Some(found) => Holding::of(found == mode),
            None => Holding::Undecided,
        },
        _ => Holding::Undecided,
    }
}

fn mode_changes(found: &[&Reading]) -> Holding {
    let modes: Option<Vec<usize>> = found.iter().map(|r| r.dominant_mode()).collect();
    match modes {
        Some(modes) => Holding::of(modes.iter().any(|mode| Some(mode) != modes.first())),
        None => Holding::Undecided,
    }
}

/// The greatest of some sizes by the least.
fn spread(sizes: &[f64]) -> f64 {
    let least = sizes.iter().copied().fold(f64::INFINITY, f64::min);
    sizes.iter().copied().fold(0.0, f64::max) / least
}

fn is_steady(found: &[&Reading]) -> Holding {
    let spans = spread(&sizes(found, |r| r.dr.span));
    let rms = spread(&sizes(found, |r| r.dr.rms));
    let transmission = spread(&sizes(found, |r| r.transmission.span));
    if !(spans.is_finite() && rms.is_finite() && transmission.is_finite()) {
        return Holding::Undecided;
    }
    Holding::of(spans < LITTLE && rms < LITTLE && spans < transmission)
}

/// The readings are those of the first frequency followed by those of the second.
fn frequency_matters(found: &[&Reading]) -> Holding {
    let (one, other) = found.split_at(found.len() / 2);
    let pairs: Vec<Holding> = one
        .iter()
        .zip(other)
        .map(|(a, b)| differ(&[a, b]))
        .collect();
    if pairs.contains(&Holding::Holds) {
        Holding::Holds
    } else if pairs.contains(&Holding::Undecided) {
        Holding::Undecided
    } else {
        Holding::Fails
    }
}

fn differ(found: &[&Reading]) -> Holding {
    match found {
        [a, b] if a.kind != Kind::Unknown && b.kind != Kind::Unknown => {
            Holding::of(a.kind != b.kind)
        }
        _ => Holding::Undecided,
    }
}

fn agree(found: &[&Reading]) -> Holding {
    let spans = spread(&sizes(found, |r| r.dr.span));
    let rms = spread(&sizes(found, |r| r.dr.rms));
    if spans.is_finite() && rms.is_finite() {
        Holding::of(spans < 1.0 + CONVERGED && rms < 1.0 + CONVERGED)
    } else {
        Holding::Undecided
    }
}
