//! Models, possibly valid, that the oracle does not support.

use std::fmt;

/// Reason why the oracle cannot evaluate a model or a state.
#[derive(Clone, Debug, PartialEq)]
pub enum OracleError {
    /// Second time derivative in an expression.
    Acceleration(String),
    /// Time derivative of an input without given rates, or kinetic energy that depends on one.
    InputRate(String),
    /// Field, position, mode or shape outside of `at`, `integral` or `sum`.
    MisplacedField(String),
    /// Parameter, domain or position that is not finite.
    NonFiniteConstant(String),
    /// Number of parameters, states or inputs that does not match the model.
    WrongLength {
        /// Name of the counted items, in the plural.
        what: &'static str,
        /// Expected number.
        expected: usize,
        /// Number in the call.
        found: usize,
    },
}

impl fmt::Display for OracleError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Acceleration(place) => write!(formatter, "{place} contains an acceleration"),
            Self::InputRate(place) => write!(
                formatter,
                "{place} needs the rate of an input; set `rates` of the input"
            ),
            Self::MisplacedField(place) => write!(
                formatter,
                "{place} uses a field, a position or a mode outside of `at`, `integral` or `sum`"
            ),
            Self::NonFiniteConstant(place) => write!(formatter, "{place} is not a finite number"),
            Self::WrongLength {
                what,
                expected,
                found,
            } => write!(formatter, "found {found} {what}, expected {expected}"),
        }
    }
}

impl std::error::Error for OracleError {}
