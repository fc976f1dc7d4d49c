//! Emitted source.

use eomgen_codegen::program::Program;
use eomgen_codegen::rust::{Packaging, emit};

use crate::error::{Error, Result};

/// The emitted source of a program.
pub fn source(program: &Program, packaging: Packaging) -> Result<String> {
    emit(program, packaging).map_err(|error| Error::input(error.to_string()))
}
