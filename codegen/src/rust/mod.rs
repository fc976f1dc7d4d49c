//! The Rust backend: one source file per variant, `no_std`, without dependency,
//! allocation or panic, that compiles on its own with any edition.
//!
//! `file` lays the items out, `types` writes parameters and coefficients, `stages` the
//! functions (`requested`, `regimes` and `jacobians` those on request), `body` (with `blocks` for matrices) writes the statements of a stage out of
//! `expression`s, `scalar` the trait of the numbers, `functions` (with `slopes` and `piecewise`) the
//! elementary functions, `literals` numbers and names. All of it reads the program alone.

mod blocks;
mod body;
mod expression;
mod file;
mod functions;
mod jacobians;
mod layout;
mod literals;
mod names;
mod piecewise;
mod regimes;
mod requested;
mod scalar;
mod slopes;
mod stages;
mod types;

use crate::program::ValueId;
pub use file::{ITEMS_MODULE, Packaging, emit};

/// Why a program could not be emitted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EmitError {
    /// A name is no Rust identifier.
    Name(String),
    /// A value does not stand where a stage needs it: a defect of the generator.
    Value(String),
}

impl EmitError {
    /// A value that stands where a value of its kind has no source.
    fn misplaced(id: ValueId, kind: &str) -> Self {
        Self::Value(format!("value {} {kind} where it stands", id.index()))
    }
}

impl std::fmt::Display for EmitError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Name(name) => write!(f, "`{name}` is no Rust identifier"),
            Self::Value(message) => write!(f, "the program cannot be emitted: {message}"),
        }
    }
}

impl std::error::Error for EmitError {}
