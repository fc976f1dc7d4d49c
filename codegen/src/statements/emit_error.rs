//! Errors of the emission of a program.

use crate::program::ValueId;

/// Reason why a program cannot be emitted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EmitError {
    /// Name that is not an identifier in the language of the emitted source.
    Name {
        /// The name.
        name: String,
        /// The language.
        language: &'static str,
    },
    /// Emitted header that would replace a system header.
    Header {
        /// Name of the model.
        name: String,
        /// Name of the other header, without its ending.
        hidden: String,
    },
    /// Two entries of the specification that would have the same name in the emitted source.
    Collision {
        /// Name of both items.
        name: String,
        /// Sections of the specification.
        owners: [String; 2],
    },
    /// Value that its stage can neither compute nor read: a defect of the generator.
    Value(String),
}

impl EmitError {
    /// Returns the error for a value of the wrong kind.
    pub(super) fn misplaced_value(id: ValueId, kind: &str) -> Self {
        Self::Value(format!("value {} {kind}", id.index()))
    }
}

impl std::fmt::Display for EmitError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Name { name, language } => write!(
                f,
                "`{name}` is not a valid {language} identifier: rename it in the specification"
            ),
            Self::Header { name, hidden } => write!(
                f,
                "`{name}.h` would replace the system header <{hidden}.h>: give the model another name"
            ),
            Self::Collision {
                name,
                owners: [first, second],
            } => write!(
                f,
                "[{first}] and [{second}] would both have the item `{name}`: rename one of them in the specification"
            ),
            Self::Value(message) => {
                write!(f, "the program cannot be emitted: {message}")
            }
        }
    }
}

impl std::error::Error for EmitError {}

pub(crate) type EmitResult<T> = Result<T, EmitError>;
