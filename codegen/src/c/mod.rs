//! C backend: a header and one source file for each variant, in C99 that is also valid C++, without allocation or
//! library calls. Its results are bit-identical to those of the emitted Rust.
//!
//! `emit` arranges both files: `file_names` checks the name of the header, `header` declares, `types` prepares the
//! coefficients, `stages`, `regimes`, `jacobians` and `controllers` write functions, `functions` their helpers,
//! with the operations on bits of `primitives`; `vectors` writes test vectors. `casadi` and `cuda` are additional
//! interfaces. `expression` writes statements, `comments` documentation, `names` all names; `standard_macros` hides
//! macros of the caller with these names. [`statements`](crate::statements) decides
//! the order of computation.

mod casadi;
mod comments;
mod controllers;
mod cuda;
mod emit;
mod expression;
mod file_names;
mod functions;
mod header;
mod jacobians;
mod names;
mod primitives;
mod reactions;
mod real;
mod regimes;
mod sine_and_cosine;
mod stages;
mod standard_macros;
mod step;
mod types;
mod vectors;

pub use crate::statements::EmitError;
pub use casadi::{CASADI_OUTPUTS, emit_casadi};
pub use cuda::emit_cuda;
pub use emit::{Files, emit, emit_header_only, emit_with};
pub use real::Real;
pub use vectors::{baked, vectors};

/// Returns true if a name is a valid identifier and not a reserved word of C or C++.
pub fn is_identifier(name: &str) -> bool {
    names::WORDS.identifier(name).is_ok()
}
