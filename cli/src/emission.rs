//! Emitted source.

use codegen::program::Program;
use codegen::rust::{Packaging, emit};

use crate::problem::{Outcome, Problem};

/// The emitted source of a program.
pub fn source(program: &Program, packaging: Packaging) -> Outcome<String> {
    emit(program, packaging).map_err(|error| Problem::input(error.to_string()))
}
