//! Why an effect is not accepted.

use std::fmt;

use crate::thresholds;

/// What an effect lacks.
#[derive(Clone, Debug, PartialEq)]
pub enum Rejection {
    /// A declared unknown that runs to the end of what is admitted.
    AtLimit(String),
    /// A parameter that a bound holds, with which the effect vanishes.
    WrongSign(String),
    /// An unknown that may be within its prior still.
    WithinPrior {
        /// Which.
        name: String,
        /// How many standard deviations of its prior it is off.
        off: f64,
        /// One standard deviation of that.
        sd: f64,
    },
    /// The part by which the gap of the test records falls is too small.
    HeldOut(f64),
    /// The number of standard errors by which it falls is too small.
    StandardErrors(f64),
    /// The information in the training records is less than this, which is asked for.
    Information {
        /// What there is.
        found: f64,
        /// What is asked for.
        asked: f64,
    },
    /// Its size in standard deviations is too small.
    Significance(f64),
    /// What it does is too small a part of the noise.
    Size(f64),
    /// Beside another effect it leaves much.
    LeavesMuch,
    /// The parts of the gap that it closes on training and on test records are too small.
    Closes {
        /// On the training records.
        train: f64,
        /// On the test records.
        test: f64,
    },
}

impl fmt::Display for Rejection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AtLimit(name) => write!(f, "{name} runs to the end of what is admitted"),
            Self::WrongSign(name) => write!(
                f,
                "{name} has the wrong sign: held to it, the effect vanishes"
            ),
            Self::WithinPrior { name, off, sd } => write!(
                f,
                "{name} is {off:.1} ± {sd:.1} standard deviations of its prior off, {} are asked for",
                thresholds::SHIFTED
            ),
            Self::HeldOut(part) => write!(
                f,
                "the test records are no better for it: the gap falls by {:.1} %, {:.0} % are asked for",
                100.0 * part,
                100.0 * thresholds::HELD_OUT
            ),
            Self::StandardErrors(errors) => write!(
                f,
                "the test records may be better by chance: {errors:.1} standard errors, {} are asked for",
                thresholds::STANDARD_ERRORS
            ),
            Self::Information { found, asked } => write!(
                f,
                "too small a gain in the training records: {found:.1}, {asked} are asked for"
            ),
            Self::Significance(t) => write!(
                f,
                "its size is {t:.1} standard deviations, {} are asked for",
                thresholds::SIGNIFICANCE
            ),
            Self::Size(size) => write!(
                f,
                "what it does is {size:.2} of the noise, {} are asked for",
                thresholds::SIZE
            ),
            Self::LeavesMuch => f.write_str("beside another it leaves much, which may be luck"),
            Self::Closes { train, test } => write!(
                f,
                "it closes {:.0} % of the gap in training and {:.0} % in test, {:.0} % are asked for",
                100.0 * train,
                100.0 * test,
                100.0 * thresholds::UNNAMED_CLOSES
            ),
        }
    }
}

impl std::error::Error for Rejection {}
