//! Verdicts on claims, with their evidence.

use std::collections::BTreeMap;

use super::claims::{Claim, Rule};
use super::reading::{CaseKey, Kind, Reading};

/// Readings of the measured cases.
pub type Readings = BTreeMap<CaseKey, Reading>;

/// Relative decrease that still counts as growth, because the extremes of a chaotic record scatter.
const MAX_RELATIVE_DECREASE: f64 = 0.01;
/// Smallest relative growth in total.
const MIN_TOTAL_GROWTH: f64 = 0.05;
/// Largest ratio of two amplitudes that counts as a small change.
const MAX_LITTLE_RATIO: f64 = 1.5;
/// Largest relative difference between converged truncation orders.
const MAX_CONVERGED_DIFFERENCE: f64 = 0.02;

/// Verdict on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
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
    pub holding: Verdict,
    /// Verdict in the strict reading of quasi-periodic motion and of Eq. (24).
    pub strict: Verdict,
    /// Evidence as text.
    pub evidence: String,
}

impl Verdict {
    /// Returns the letter in tables: H, F or U.
    pub fn letter(self) -> char {
        match self {
            Self::Holds => 'H',
            Self::Fails => 'F',
            Self::Undecided => 'U',
        }
    }

    fn from_condition(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::Fails }
    }

    /// Combines verdicts: holds if all hold, fails if one fails.
    fn combine(parts: &[Self]) -> Self {
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
            holding: Verdict::Undecided,
            strict: Verdict::Undecided,
            evidence: "a case could not be measured".to_owned(),
        };
    };
    let (holding, strict) = match claim.rule {
        Rule::Regular(_) => (
            judge_kind(&found, Kind::Regular),
            judge_quasi_periodic(&found),
        ),
        Rule::Chaotic(_) => repeat_for_both_readings(judge_kind(&found, Kind::Chaotic)),
        Rule::Route(_) => (judge_route(&found), judge_strict_route(&found)),
        Rule::ErrorGrows(_) => judge_error_growth(&found),
        Rule::DeflectionDominates(_) => repeat_for_both_readings(judge_dominance(&found, 1.0)),
        Rule::TransmissionDominates(_) => repeat_for_both_readings(judge_dominance(&found, -1.0)),
        Rule::ShareGrows(_) => repeat_for_both_readings(judge_growth(&list_sizes(&found, |r| {
            r.transmission.span / r.dr.span
        }))),
        Rule::DominantMode(_, mode) => repeat_for_both_readings(judge_dominant_mode(&found, mode)),
        Rule::ModeChanges(_) => repeat_for_both_readings(judge_mode_change(&found)),
        Rule::DeflectionSteady(_) => repeat_for_both_readings(judge_steadiness(&found)),
        Rule::FrequencyMatters => repeat_for_both_readings(judge_frequency(&found)),
        Rule::FlexibilityMatters => repeat_for_both_readings(judge_difference(&found)),
        Rule::OrderSuffices => repeat_for_both_readings(judge_agreement(&found)),
    };
    Judgement {
        holding,
        strict,
        evidence: super::evidence::format_evidence(claim.rule, &keys, &found),
    }
}

fn repeat_for_both_readings(holding: Verdict) -> (Verdict, Verdict) {
    (holding, holding)
}

fn judge_kind(found: &[&Reading], kind: Kind) -> Verdict {
    match found {
        [reading] if reading.kind != Kind::Unknown => Verdict::from_condition(reading.kind == kind),
        _ => Verdict::Undecided,
    }
}

fn judge_quasi_periodic(found: &[&Reading]) -> Verdict {
    match found {
        [reading] if reading.kind != Kind::Unknown => {
            Verdict::from_condition(reading.is_strictly_quasi_periodic)
        }
        _ => Verdict::Undecided,
    }
}

/// Judges a route to chaos: motion may become chaotic anywhere between the ends, but not regular again. The verdict is
/// undecided if the unknown cases permit both.
fn judge_route(found: &[&Reading]) -> Verdict {
    let (Some(first), Some(last)) = (found.first(), found.last()) else {
        return Verdict::Undecided;
    };
    let kinds: Vec<Kind> = found.iter().map(|reading| reading.kind).collect();
    // A chaotic case before a regular one is a return to regular motion; an unknown case may be chaotic or regular.
    let pairs = |before: &[Kind], after: &[Kind]| {
        let turns = |(index, kind): (usize, &Kind)| {
            before.contains(kind) && kinds.iter().skip(index + 1).any(|k| after.contains(k))
        };
        kinds.iter().enumerate().any(turns)
    };
    let back = if pairs(&[Kind::Chaotic], &[Kind::Regular]) {
        Verdict::Fails
    } else if pairs(
        &[Kind::Chaotic, Kind::Unknown],
        &[Kind::Regular, Kind::Unknown],
    ) {
        Verdict::Undecided
    } else {
        Verdict::Holds
    };
    Verdict::combine(&[
        judge_kind(&[first], Kind::Regular),
        judge_kind(&[last], Kind::Chaotic),
        back,
    ])
}

/// Judges a route to chaos that must start with quasi-periodic motion in the strict sense, at the smallest backlash.
fn judge_strict_route(found: &[&Reading]) -> Verdict {
    let first = found
        .first()
        .map_or(Verdict::Undecided, |first| judge_quasi_periodic(&[first]));
    Verdict::combine(&[judge_route(found), first])
}

fn list_sizes(found: &[&Reading], size: impl Fn(&Reading) -> f64) -> Vec<f64> {
    found.iter().map(|reading| size(reading)).collect()
}

fn judge_growth(sizes: &[f64]) -> Verdict {
    let steps = sizes.windows(2).all(|pair| match pair {
        [before, after] => *after >= before * (1.0 - MAX_RELATIVE_DECREASE),
        _ => true,
    });
    match (sizes.first(), sizes.last()) {
        (Some(first), Some(last)) if sizes.iter().all(|size| size.is_finite()) => {
            Verdict::from_condition(steps && *last >= first * (1.0 + MIN_TOTAL_GROWTH))
        }
        _ => Verdict::Undecided,
    }
}

/// Returns two verdicts: for the error with the correct sign or as printed, and for the error as printed.
fn judge_error_growth(found: &[&Reading]) -> (Verdict, Verdict) {
    let printed = judge_growth(&list_sizes(found, |r| r.f_la.largest));
    let signed = judge_growth(&list_sizes(found, |r| r.f_la_signed.largest));
    match (printed, signed) {
        (Verdict::Holds, _) | (_, Verdict::Holds) => (Verdict::Holds, printed),
        _ => (printed, printed),
    }
}

/// Compares dr with l dtheta, peak to peak and in RMS: dr must be larger for `sign` 1, smaller for `sign` -1.
fn judge_dominance(found: &[&Reading], sign: f64) -> Verdict {
    let [reading] = found else {
        return Verdict::Undecided;
    };
    let (dr, transmission) = (&reading.dr, &reading.transmission);
    let span = sign * (dr.span - transmission.span);
    let rms = sign * (dr.rms - transmission.rms);
    if span > 0.0 && rms > 0.0 {
        Verdict::Holds
    } else if span < 0.0 && rms < 0.0 {
        Verdict::Fails
    } else {
        Verdict::Undecided
    }
}

fn judge_dominant_mode(found: &[&Reading], mode: usize) -> Verdict {
    match found {
        [reading] => match reading.dominant_mode() {
            Some(found) => Verdict::from_condition(found == mode),
            None => Verdict::Undecided,
        },
        _ => Verdict::Undecided,
    }
}

fn judge_mode_change(found: &[&Reading]) -> Verdict {
    let modes: Option<Vec<usize>> = found.iter().map(|r| r.dominant_mode()).collect();
    match modes {
        Some(modes) => {
            Verdict::from_condition(modes.iter().any(|mode| Some(mode) != modes.first()))
        }
        None => Verdict::Undecided,
    }
}

/// Returns the ratio of the largest to the smallest size.
fn size_ratio(sizes: &[f64]) -> f64 {
    let least = sizes.iter().copied().fold(f64::INFINITY, f64::min);
    sizes.iter().copied().fold(0.0, f64::max) / least
}

fn judge_steadiness(found: &[&Reading]) -> Verdict {
    let spans = size_ratio(&list_sizes(found, |r| r.dr.span));
    let rms = size_ratio(&list_sizes(found, |r| r.dr.rms));
    let transmission = size_ratio(&list_sizes(found, |r| r.transmission.span));
    if !(spans.is_finite() && rms.is_finite() && transmission.is_finite()) {
        return Verdict::Undecided;
    }
    Verdict::from_condition(
        spans < MAX_LITTLE_RATIO && rms < MAX_LITTLE_RATIO && spans < transmission,
    )
}

/// Judges whether the frequency matters. `found` has the readings of the first frequency, then those of the second.
fn judge_frequency(found: &[&Reading]) -> Verdict {
    let (one, other) = found.split_at(found.len() / 2);
    let pairs: Vec<Verdict> = one
        .iter()
        .zip(other)
        .map(|(a, b)| judge_difference(&[a, b]))
        .collect();
    if pairs.contains(&Verdict::Holds) {
        Verdict::Holds
    } else if pairs.contains(&Verdict::Undecided) {
        Verdict::Undecided
    } else {
        Verdict::Fails
    }
}

fn judge_difference(found: &[&Reading]) -> Verdict {
    match found {
        [a, b] if a.kind != Kind::Unknown && b.kind != Kind::Unknown => {
            Verdict::from_condition(a.kind != b.kind)
        }
        _ => Verdict::Undecided,
    }
}

fn judge_agreement(found: &[&Reading]) -> Verdict {
    let spans = size_ratio(&list_sizes(found, |r| r.dr.span));
    let rms = size_ratio(&list_sizes(found, |r| r.dr.rms));
    if spans.is_finite() && rms.is_finite() {
        Verdict::from_condition(
            spans < 1.0 + MAX_CONVERGED_DIFFERENCE && rms < 1.0 + MAX_CONVERGED_DIFFERENCE,
        )
    } else {
        Verdict::Undecided
    }
}
