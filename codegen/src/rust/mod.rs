//! The Rust backend: one source file per variant, `no_std`, without dependency,
//! allocation or panic, that compiles on its own with any edition.
//!
//! `file` lays the items out, `types` writes parameters and coefficients, `stages` the
//! functions (`outputs`, `regimes` and `jacobians` those on request), `body` (with `operands`, and `blocks` for matrices) writes the statements of a stage out of
//! `expression`s, `scalar` the trait of the numbers, `functions` (with `kernels`, `slopes` and `piecewise`) the
//! functions that they call, `literals` numbers and names. All of it reads the program alone.

mod blocks;
mod body;
mod constants;
mod emit;
mod emit_error;
mod expression;
mod file;
mod functions;
mod jacobians;
mod kernels;
mod layout;
mod literals;
mod names;
mod operands;
mod outputs;
mod piecewise;
mod regimes;
mod roots;
mod rows;
mod scalar;
mod sides;
mod signature;
mod slopes;
mod stages;
mod types;

pub use emit::{ITEMS_MODULE, Packaging, emit};
pub use emit_error::EmitError;
