//! Why the oracle cannot judge a model. None of these is a fault of the model: the
//! oracle refuses what it would have to guess.

use std::fmt;

/// Why a model, or a state of it, cannot be evaluated by the oracle.
#[derive(Clone, Debug, PartialEq)]
pub enum OracleError {
    /// A time derivative of something that holds a time derivative: an acceleration.
    Acceleration(String),
    /// The time derivative of an input, or a kinetic energy with an input in it.
    InputRate(String),
    /// A field, position, mode or shape outside the functions that give it a place.
    Misplaced(String),
    /// Parameters, a domain or a position whose value is not a finite number.
    NotFinite(String),
    /// A number of parameters, states or inputs that does not fit the model.
    Length {
        /// What was counted.
        what: &'static str,
        /// How many there must be.
        expected: usize,
        /// How many there were.
        found: usize,
    },
}

impl fmt::Display for OracleError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Acceleration(place) => write!(formatter, "{place} holds an acceleration"),
            Self::InputRate(place) => write!(formatter, "{place} needs the rate of an input"),
            Self::Misplaced(place) => write!(
                formatter,
                "{place} uses a field, a position or a mode outside at, integral or sum"
            ),
            Self::NotFinite(place) => write!(formatter, "{place} is not a finite number"),
            Self::Length {
                what,
                expected,
                found,
            } => write!(formatter, "{found} {what} instead of {expected}"),
        }
    }
}

impl std::error::Error for OracleError {}
