//! The C backend: a header and one source file per variant, C99 that is C++ as well, without
//! allocation or library, with the bits of the emitted Rust.
//!
//! `emit` lays both files out: `header` declares, `types` prepares the coefficients, `stages` are
//! the functions (`regimes` and `jacobians` more of those on request), `functions` what they call.
//! `casadi` is a second interface to them. `expression` writes the statements, `comments` the documentation, `names` every name. What is
//! computed in which order comes from [`statements`](crate::statements).

mod casadi;
mod comments;
mod emit;
mod expression;
mod functions;
mod header;
mod jacobians;
mod names;
mod regimes;
mod sine_and_cosine;
mod stages;
mod types;

pub use crate::statements::EmitError;
pub use casadi::{CASADI_OUTPUTS, emit_casadi};
pub use emit::{Files, emit};
