//! Reasons why an effect is rejected.

use std::fmt;

use crate::thresholds;

/// Failed criterion of an effect.
#[derive(Clone, Debug, PartialEq)]
pub enum Rejection {
    /// A declared unknown is at the end of its admissible range.
    AtLimit(String),
    /// A parameter is at the bound at which the effect vanishes.
    WrongSign(String),
    /// An unknown may be within the range of its prior.
    WithinPrior {
        /// Name of the unknown.
        name: String,
        /// Distance from the prior mean, in standard deviations of the prior.
        deviation: f64,
        /// Standard deviation of this distance.
        sd: f64,
    },
    /// The relative reduction of the test gap is too small.
    HeldOut(f64),
    /// The search was stopped before the comparison with the test records.
    Interrupted,
    /// The reduction in standard errors is too small.
    StandardErrors(f64),
    /// The information gain in the training records is too small.
    Information {
        /// Information gain.
        gain: f64,
        /// Required gain.
        required: f64,
    },
    /// The size in standard deviations is too small.
    Significance(f64),
    /// The influence relative to the noise is too small.
    Influence(f64),
    /// The pair leaves a large residual.
    LargeRemainder,
    /// The effect closes too small a fraction of the gap.
    Closure {
        /// Fraction closed on the training records.
        train: f64,
        /// Fraction closed on the test records.
        test: f64,
    },
}

impl fmt::Display for Rejection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AtLimit(name) => write!(f, "{name} is at a limit of its admissible range"),
            Self::WrongSign(name) => write!(
                f,
                "{name} has the wrong sign: its fitted value is the bound at which the effect vanishes"
            ),
            Self::WithinPrior {
                name,
                deviation: off,
                sd,
            } => write!(
                f,
                "{name} is {off:.1} ± {sd:.1} standard deviations of its prior from the mean, {} are required",
                thresholds::MAX_PRIOR_DEVIATION
            ),
            Self::HeldOut(part) => {
                let (verb, size) = match *part < 0.0 {
                    true => ("grows", -part),
                    false => ("falls", *part),
                };
                write!(
                    f,
                    "the test records do not improve enough: their residual {verb} by {:.1} %; it must fall by {:.0} % \
                     or more",
                    100.0 * size,
                    100.0 * thresholds::MIN_HELD_OUT_REDUCTION
                )
            }
            Self::Interrupted => f.write_str("stopped before the comparison with the test records"),
            Self::StandardErrors(errors) => write!(
                f,
                "the improvement of the test records may be due to chance: {errors:.1} standard errors, {} are \
                 required",
                thresholds::MIN_REDUCTION_STANDARD_ERRORS
            ),
            Self::Information {
                gain: found,
                required,
            } => write!(
                f,
                "the information gain in the training records is too small: {found:.1}, {required} are required"
            ),
            Self::Significance(t) => write!(
                f,
                "its size is {t:.1} standard deviations, {} are required",
                thresholds::MIN_SIGNIFICANCE
            ),
            Self::Influence(size) => write!(
                f,
                "its influence is {size:.2} standard deviations of the noise, {} are required",
                thresholds::MIN_EFFECT_OVER_NOISE
            ),
            Self::LargeRemainder => f.write_str(
                "together with another effect a large residual remains; the fit may be due to chance",
            ),
            Self::Closure { train, test } => write!(
                f,
                "it closes {:.0} % of the gap in the training records and {:.0} % of the gap in the test records; \
                 {:.0} % of each is required",
                100.0 * train,
                100.0 * test,
                100.0 * thresholds::MIN_EXPRESSION_CLOSURE
            ),
        }
    }
}

impl std::error::Error for Rejection {}
