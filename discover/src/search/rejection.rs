//! Reasons why an effect is rejected.

use std::fmt;

use crate::thresholds;

/// Failed criterion of an effect.
#[derive(Clone, Debug, PartialEq)]
pub enum Rejection {
    /// A declared unknown at the end of its admissible range.
    AtLimit(String),
    /// A parameter at a bound at which the effect vanishes.
    WrongSign(String),
    /// An unknown that may be within its prior.
    WithinPrior {
        /// Name of the unknown.
        name: String,
        /// Distance from the prior mean, in standard deviations of the prior.
        off: f64,
        /// Standard deviation of that distance.
        sd: f64,
    },
    /// The relative reduction of the test gap is too small.
    HeldOut(f64),
    /// The reduction in standard errors is too small.
    StandardErrors(f64),
    /// The information gain in the training records is too small.
    Information {
        /// Information gain.
        found: f64,
        /// Required gain.
        asked: f64,
    },
    /// The size in standard deviations is too small.
    Significance(f64),
    /// The influence relative to the noise is too small.
    Size(f64),
    /// A large residual remains next to another effect.
    LeavesMuch,
    /// The closed fractions of the gap are too small.
    Closes {
        /// Fraction closed on the training records.
        train: f64,
        /// Fraction closed on the test records.
        test: f64,
    },
}

impl fmt::Display for Rejection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AtLimit(name) => write!(f, "{name} is at the end of its admissible range"),
            Self::WrongSign(name) => write!(
                f,
                "{name} has the wrong sign: at its bound the effect vanishes"
            ),
            Self::WithinPrior { name, off, sd } => write!(
                f,
                "{name} is {off:.1} ± {sd:.1} standard deviations of its prior from the mean, {} are required",
                thresholds::SHIFTED
            ),
            Self::HeldOut(part) => write!(
                f,
                "the test records do not improve: the gap decreases by {:.1} %, {:.0} % are required",
                100.0 * part,
                100.0 * thresholds::HELD_OUT
            ),
            Self::StandardErrors(errors) => write!(
                f,
                "the improvement of the test records may be chance: {errors:.1} standard errors, {} are required",
                thresholds::STANDARD_ERRORS
            ),
            Self::Information { found, asked } => write!(
                f,
                "the information gain in the training records is too small: {found:.1}, {asked} are required"
            ),
            Self::Significance(t) => write!(
                f,
                "its size is {t:.1} standard deviations, {} are required",
                thresholds::SIGNIFICANCE
            ),
            Self::Size(size) => write!(
                f,
                "its influence is {size:.2} standard deviations of the noise, {} are required",
                thresholds::SIZE
            ),
            Self::LeavesMuch => f.write_str(
                "together with another effect a large residual remains, which may \
             be chance",
            ),
            Self::Closes { train, test } => write!(
                f,
                "it closes {:.0} % of the gap in training and {:.0} % in test, {:.0} % are required",
                100.0 * train,
                100.0 * test,
                100.0 * thresholds::UNNAMED_CLOSES
            ),
        }
    }
}

impl std::error::Error for Rejection {}
