//! Errors of the oracle, including valid models that it does not support.

use thiserror::Error;

/// Reason why the oracle cannot evaluate a model or a state.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum OracleError {
    #[error("{0} contains an acceleration")]
    /// Second time derivative in an expression.
    Acceleration(String),
    #[error("{0} needs the rate of an input; set `rates` of the input")]
    /// Time derivative of an input without given rates, or kinetic energy that depends on one.
    InputRate(String),
    #[error("{0} uses a field, a position or a mode outside of `at`, `integral` or `sum`")]
    /// Field, position, mode or shape outside of `at`, `integral` or `sum`.
    MisplacedField(String),
    #[error("{0} is not a finite number")]
    /// Parameter, domain or position that is not finite.
    NonFiniteConstant(String),
    #[error("found {found} {what}, expected {expected}")]
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
