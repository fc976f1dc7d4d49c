//! Errors of the emission of a program.

use thiserror::Error;

use crate::program::ValueId;

/// Reason why a program cannot be emitted.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum EmitError {
    #[error("`{name}` is not a valid {language} identifier: rename it in the specification")]
    /// Name that is not an identifier in the language of the emitted source.
    Name {
        /// The name.
        name: String,
        /// The language.
        language: &'static str,
    },
    #[error("the program cannot be emitted: {0}")]
    /// Value without source in its stage: a defect of the generator.
    Value(String),
}

impl EmitError {
    /// Returns the error for a value of the wrong kind.
    pub(super) fn misplaced_value(id: ValueId, kind: &str) -> Self {
        Self::Value(format!("value {} {kind}", id.index()))
    }
}

pub(crate) type EmitResult<T> = Result<T, EmitError>;
