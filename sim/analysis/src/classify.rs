//! Classification of a motion from several kinds of evidence, by one rule.

use std::f64::consts::TAU;
use std::fmt;

use super::exponent::Exponent;

/// Kind of motion under periodic forcing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Periodic motion.
    Periodic {
        /// Period in forcing periods.
        period_multiple: usize,
    },
    /// Motion with several frequencies without a common period.
    QuasiPeriodic,
    /// Motion from which neighbouring motions separate exponentially.
    Chaotic,
    /// Insufficient or contradictory evidence.
    Undecided,
}

/// Evidence on a motion after its transient. Missing evidence is `None`; a number that is not
/// finite counts as `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evidence {
    /// Largest Lyapunov exponent, 1/s.
    pub exponent: Option<Exponent>,
    /// K of the 0-1 test, for a series sampled once per forcing period.
    pub chaos_indicator: Option<f64>,
    /// Period of the section, in forcing periods.
    pub period: Option<usize>,
    /// Share of spectral lines in the power outside the forcing harmonics. The harmonics are
    /// excluded, because they contain nearly all power of every forced motion.
    pub line_share: Option<f64>,
    /// Forcing frequency, rad/s.
    pub forcing: f64,
}

/// Classification with its reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// Kind of motion.
    pub motion: Motion,
    /// Sentence with the kind, the reason and the numbers.
    pub sentence: String,
}

/// Smallest growth per forcing period that counts as growth: a factor e in 100 periods. In a finite record, the
/// exponent of a neutral direction is smaller.
pub const MIN_GROWTH_PER_PERIOD: f64 = 0.01;
/// Largest growth per forcing period that the error of an exponent near zero may hide.
pub const MAX_HIDDEN_GROWTH_PER_PERIOD: f64 = 0.1;
/// Number of standard errors above which an exponent is significant.
pub const SIGNIFICANT_STANDARD_ERRORS: f64 = 3.0;
/// Smallest K that indicates chaos without the spectrum.
pub const MIN_CHAOTIC_K: f64 = 0.8;
/// Largest K that indicates regular motion without the spectrum.
pub const MAX_REGULAR_K: f64 = 0.2;
/// Limit of K if the spectrum gives the same indication.
pub const K_LIMIT_WITH_SPECTRUM: f64 = 0.5;
/// Largest share of spectral lines in a continuous spectrum.
pub const MAX_CONTINUOUS_LINE_SHARE: f64 = 0.5;
/// Smallest share of spectral lines in a discrete spectrum.
pub const MIN_DISCRETE_LINE_SHARE: f64 = 0.9;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Growth {
    Positive,
    NotPositive,
    Unknown,
}

/// Classifies a motion.
///
/// Let l be the exponent, s its standard error, T = 2 pi/forcing, K the chaos indicator, and L the
/// share of spectral lines in the power outside the forcing harmonics.
///
/// * l is *positive* if l > max(3 s, 0.01/T). It is *not positive* if l <= max(3 s, 0.01/T) and l +
///   3 s <= 0.1/T: a larger error could hide growth. A rigid rotation has an exponent of zero, so
///   the largest exponent is often zero and not negative.
/// * **Chaotic**: l is positive, no period was found, and K >= 0.8, or K >= 0.5 with L < 0.5.
/// * **Periodic**: l is not positive and a period was found. K and L do not count: the period is
///   exact to the tolerance of the section, and K is not a sharp test of long periods.
/// * **Quasi-periodic**: l is not positive, no period was found, and K <= 0.2, or K <= 0.5 with L >
///   0.9.
/// * **Undecided**: all other cases. Growth with a period, and growth without diffusion, are
///   contradictions; usually the record is too short or contains the transient.
///
/// A motion whose period exceeds the search limit is classified as quasi-periodic.
pub fn classify(evidence: &Evidence) -> Verdict {
    let (motion, reason) = judge(evidence);
    Verdict {
        motion,
        sentence: format!("{motion}: {reason} ({}).", EvidenceNumbers(evidence)),
    }
}

fn judge(evidence: &Evidence) -> (Motion, &'static str) {
    let k = only_finite(evidence.chaos_indicator);
    let lines = only_finite(evidence.line_share);
    match (growth(evidence), evidence.period, k) {
        (Growth::Unknown, ..) => (Motion::Undecided, "the largest exponent is too uncertain"),
        (Growth::Positive, Some(_), _) => (
            Motion::Undecided,
            "neighbouring motions separate, although the section repeats",
        ),
        (Growth::NotPositive, Some(period_multiple), _) => (
            Motion::Periodic { period_multiple },
            "the section repeats and neighbouring motions stay together",
        ),
        (_, None, None) => (Motion::Undecided, "the 0-1 test is missing"),
        (Growth::Positive, None, Some(k)) => judge_growing(k, lines),
        (Growth::NotPositive, None, Some(k)) => judge_bounded(k, lines),
    }
}

fn judge_growing(k: f64, lines: Option<f64>) -> (Motion, &'static str) {
    let is_continuous = lines.is_some_and(|share| share < MAX_CONTINUOUS_LINE_SHARE);
    if k >= MIN_CHAOTIC_K {
        let reason = "neighbouring motions separate and the 0-1 test indicates chaos";
        (Motion::Chaotic, reason)
    } else if k >= K_LIMIT_WITH_SPECTRUM && is_continuous {
        let reason = "neighbouring motions separate and the spectrum is continuous";
        (Motion::Chaotic, reason)
    } else {
        let reason = "neighbouring motions separate, although the 0-1 test does not indicate chaos";
        (Motion::Undecided, reason)
    }
}

fn judge_bounded(k: f64, lines: Option<f64>) -> (Motion, &'static str) {
    let is_discrete = lines.is_some_and(|share| share > MIN_DISCRETE_LINE_SHARE);
    if k <= MAX_REGULAR_K {
        let reason = "neighbouring motions stay together and the section neither repeats nor \
                      diffuses";
        (Motion::QuasiPeriodic, reason)
    } else if k <= K_LIMIT_WITH_SPECTRUM && is_discrete {
        let reason = "neighbouring motions stay together, the section does not repeat and the spectrum consists of \
                      lines";
        (Motion::QuasiPeriodic, reason)
    } else {
        let reason = "neighbouring motions stay together, although the 0-1 test does not indicate regular motion";
        (Motion::Undecided, reason)
    }
}

fn growth(evidence: &Evidence) -> Growth {
    let Some(Exponent {
        value,
        standard_error,
    }) = evidence.exponent
    else {
        return Growth::Unknown;
    };
    let per_second = evidence.forcing / TAU;
    let hidden = SIGNIFICANT_STANDARD_ERRORS * standard_error;
    let least = hidden.max(MIN_GROWTH_PER_PERIOD * per_second);
    let is_known =
        value.is_finite() && hidden.is_finite() && per_second.is_finite() && per_second > 0.0;
    if is_known && value > least {
        Growth::Positive
    } else if is_known && value + hidden <= MAX_HIDDEN_GROWTH_PER_PERIOD * per_second {
        Growth::NotPositive
    } else {
        Growth::Unknown
    }
}

fn only_finite(number: Option<f64>) -> Option<f64> {
    number.filter(|number| number.is_finite())
}

impl fmt::Display for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Periodic { period_multiple: 1 } => {
                write!(f, "periodic with the period of the forcing")
            }
            Self::Periodic { period_multiple } => {
                write!(f, "periodic with {period_multiple} periods of the forcing")
            }
            Self::QuasiPeriodic => write!(f, "quasi-periodic"),
            Self::Chaotic => write!(f, "chaotic"),
            Self::Undecided => write!(f, "undecided"),
        }
    }
}

struct EvidenceNumbers<'a>(&'a Evidence);

impl fmt::Display for EvidenceNumbers<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Evidence {
            exponent,
            chaos_indicator,
            period,
            line_share,
            forcing,
        } = self.0;
        match exponent {
            Some(exponent) => write!(
                f,
                "largest exponent {:.3} ± {:.3} 1/s, {:.3} per forcing period",
                exponent.value,
                exponent.standard_error,
                exponent.value * TAU / forcing
            )?,
            None => write!(f, "no exponent")?,
        }
        match only_finite(*chaos_indicator) {
            Some(k) => write!(f, "; 0-1 test K = {k:.2}")?,
            None => write!(f, "; no 0-1 test")?,
        }
        match period {
            Some(1) => write!(f, "; period 1 forcing period")?,
            Some(period) => write!(f, "; period {period} forcing periods")?,
            None => write!(f, "; no period found")?,
        }
        match only_finite(*line_share) {
            Some(share) => write!(
                f,
                "; {:.0} % of the power outside the forcing harmonics in spectral lines",
                100.0 * share
            ),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exponent::mean_exponent;
    use crate::maps::{circle, logistic};
    use crate::poincare::Section;
    use crate::spectrum::{Trend, welch};
    use crate::zero_one::chaos_indicator;

    const QUASI_PERIODIC: Evidence = Evidence {
        exponent: Some(Exponent {
            value: 0.001,
            standard_error: 0.01,
        }),
        chaos_indicator: Some(0.02),
        period: None,
        line_share: Some(0.98),
        forcing: 10.0 * std::f64::consts::PI,
    };

    fn growing(value: f64, standard_error: f64) -> Evidence {
        Evidence {
            exponent: Some(Exponent {
                value,
                standard_error,
            }),
            chaos_indicator: Some(0.97),
            line_share: Some(0.2),
            ..QUASI_PERIODIC
        }
    }

    /// Computes the evidence for a map x -> f(x) with slopes f'(x), one step per second.
    fn evidence(series: &[f64], slope: impl Fn(f64) -> f64) -> Evidence {
        let growths: Vec<f64> = series.iter().map(|x| slope(*x).abs().ln()).collect();
        let observed: Vec<f64> = series.iter().map(|x| (TAU * x).cos()).collect();
        let section = Section {
            points: &observed,
            scale: &[2.0],
        };
        let spectrum = welch(&observed, 1.0, 250, Trend::Mean).unwrap();
        Evidence {
            exponent: mean_exponent(&growths, 1.0).ok(),
            chaos_indicator: chaos_indicator(&observed).ok(),
            period: section.shape(1e-6).unwrap().period,
            line_share: spectrum.line_share(),
            forcing: TAU,
        }
    }

    #[test]
    fn known_maps_are_classified_correctly() {
        let logistic_slope = |r: f64| move |x: f64| r * (1.0 - 2.0 * x);
        let (golden, strength) = ((5_f64.sqrt() - 1.0) / 2.0, 0.8);
        let circle_slope = |x: f64| 1.0 - strength * (TAU * x).cos();
        for (motion, evidence) in [
            (
                Motion::Chaotic,
                evidence(&logistic(4.0, 2000), logistic_slope(4.0)),
            ),
            (
                Motion::Periodic { period_multiple: 4 },
                evidence(&logistic(3.5, 2000), logistic_slope(3.5)),
            ),
            (
                Motion::QuasiPeriodic,
                evidence(&circle(golden, strength, 2000), circle_slope),
            ),
        ] {
            let verdict = classify(&evidence);
            assert_eq!(verdict.motion, motion, "{}", verdict.sentence);
        }
    }

    #[test]
    fn insufficient_evidence_is_undecided() {
        let (mut repeating, mut vague) = (growing(5.0, 0.1), [QUASI_PERIODIC; 5]);
        repeating.period = Some(3);
        vague[0].exponent = None;
        vague[1].chaos_indicator = None;
        vague[2].chaos_indicator = Some(0.6);
        (vague[3].chaos_indicator, vague[3].line_share) = (Some(0.4), None);
        vague[4].forcing = 0.0;
        // A growth of 0.01 per period of 0.2 s is 0.05 1/s, one of 0.1 is 0.5 1/s. The cases are an error that
        // hides growth, diffusion with too little growth, and NaN.
        let thin = [(0.4, 0.2), (0.04, 0.0), (f64::NAN, 0.0)];
        let thin = thin.map(|(value, error)| growing(value, error));
        for evidence in thin.iter().chain(&vague).chain([&repeating]) {
            let verdict = classify(evidence);
            assert_eq!(verdict.motion, Motion::Undecided, "{}", verdict.sentence);
        }
    }

    #[test]
    fn spectrum_decides_for_moderate_k() {
        let moderate = |evidence: Evidence, k| Evidence {
            chaos_indicator: Some(k),
            ..evidence
        };
        assert_eq!(
            classify(&moderate(growing(5.0, 0.1), 0.6)).motion,
            Motion::Chaotic
        );
        assert_eq!(
            classify(&moderate(QUASI_PERIODIC, 0.4)).motion,
            Motion::QuasiPeriodic
        );
    }

    #[test]
    fn sentence_has_kind_and_numbers() {
        assert_eq!(
            classify(&growing(5.0, 0.25)).sentence,
            "chaotic: neighbouring motions separate and the 0-1 test indicates chaos (largest exponent \
             5.000 ± 0.250 1/s, 1.000 per forcing period; 0-1 test K = 0.97; no period found; \
             20 % of the power outside the forcing harmonics in spectral lines)."
        );
        let periodic = Evidence {
            period: Some(2),
            ..QUASI_PERIODIC
        };
        let sentence = classify(&periodic).sentence;
        assert!(sentence.starts_with("periodic with 2 periods of the forcing: the section"));
    }
}
