//! What keeps a program from being emitted.

use crate::program::ValueId;

/// Why a program could not be emitted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EmitError {
    /// A name is no identifier in the language of the emitted source.
    Name {
        /// The name.
        name: String,
        /// The language.
        language: &'static str,
    },
    /// A value does not stand where a stage needs it: a defect of the generator.
    Value(String),
}

impl EmitError {
    /// A value that stands where a value of its kind has no source.
    pub(super) fn misplaced(id: ValueId, kind: &str) -> Self {
        Self::Value(format!("value {} {kind} where it stands", id.index()))
    }
}

impl std::fmt::Display for EmitError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Name { name, language } => write!(
                f,
                "`{name}` is no {language} identifier: the specification has to call it otherwise"
            ),
            Self::Value(message) => write!(f, "the program cannot be emitted: {message}"),
        }
    }
}

impl std::error::Error for EmitError {}

/// What comes of writing a part of the file.
pub(crate) type Emitted<T> = Result<T, EmitError>;
