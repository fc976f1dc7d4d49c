//! Verdicts on claims, with their evidence.

use std::collections::BTreeMap;

use super::claims::{Claim, Rule};
use super::reading::{Key, Kind, Reading};

/// Readings by case.
pub type Readings = BTreeMap<Key, Reading>;

/// Relative decrease that still counts as growth, because the extremes of a chaotic record scatter.
const FORGIVEN: f64 = 0.01;
/// Smallest total growth.
const GAINED: f64 = 0.05;
/// Largest ratio of a little change.
const LITTLE: f64 = 1.5;
/// Largest relative difference between converged truncation orders.
const CONVERGED: f64 = 0.02;

/// Verdict on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Holding {
    /// The claim holds.
    Holds,
    /// The claim fails.
    Fails,
    /// The evidence is missing or does not decide.
    Undecided,
}

/// Judged claim.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Judgement {
    /// Verdict in the generous reading: any regular motion counts as the paper's quasi-periodic
    /// motion, and the positioning error may have either sign.
    pub holding: Holding,
    /// Verdict in the strict reading of quasi-periodic motion and of Eq. (24).
    pub strict: Holding,
    /// Evidence as text.
    pub evidence: String,
}

impl Holding {
    /// Returns the letter in tables: H, F or U.
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

    /// Holds if all hold, fails if one fails.
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

/// Judges a route: motion may become chaotic anywhere between the ends, but not regular again. It
/// is undecided if the unknown cases permit both.
fn route(found: &[&Reading]) -> Holding {
    let (Some(first), Some(last)) = (found.first(), found.last()) else {
        return Holding::Undecided;
    };
    let kinds: Vec<Kind> = found.iter().map(|reading| reading.kind).collect();
    // A chaotic case before a regular one is a return; an unknown case may be one.
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

/// Requires quasi-periodic motion in the strict sense at the smallest backlash.
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

/// Returns the verdicts with either sign of the transmission error, and as printed.
fn error_grows(found: &[&Reading]) -> (Holding, Holding) {
    let printed = grows(&sizes(found, |r| r.f_la.largest));
    let signed = grows(&sizes(found, |r| r.f_la_signed.largest));
    match (printed, signed) {
        (Holding::Holds, _) | (_, Holding::Holds) => (Holding::Holds, printed),
        _ => (printed, printed),
    }
}

/// Compares dr with l dtheta by both measures: larger for `sign` 1, smaller for -1.
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

/// Returns the ratio of the greatest to the least size.
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

/// Expects the readings of the first frequency, then those of the second.
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
