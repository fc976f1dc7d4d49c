//! The Rust backend: one source file per variant, `no_std`, without dependency,
//! allocation or panic, that compiles on its own with any edition.
//!
//! `emit` lays the items out, `types` writes parameters and coefficients, `stages` the functions
//! (`regimes` and `jacobians` more of those on request, `signature` their heads), `expression` the
//! statements and expressions in them, `scalar` the trait of the numbers, `functions` (with
//! `kernels`, `slopes` and `piecewise`) the functions that they call, `literals` numbers and
//! documentation, `layout` the lines. What is computed in which order comes from
//! [`statements`](crate::statements).

mod constants;
mod emit;
mod expression;
mod functions;
mod generics;
mod jacobians;
mod kernels;
mod literals;
mod piecewise;
mod regimes;
mod scalar;
mod signature;
mod slopes;
mod stages;
mod types;
mod words;

pub use crate::statements::EmitError;
pub use emit::{ITEMS_MODULE, Packaging, emit};
