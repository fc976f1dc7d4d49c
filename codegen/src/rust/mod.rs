//! Rust backend: one source file for each variant, `no_std`, without dependencies, allocations or panics, for
//! every edition.
//!
//! `emit` arranges the items, `types` writes parameters and coefficients, `stages`, `regimes`, `jacobians` and
//! `controllers` write functions, `signature` their heads, `expression` their statements. `scalar` is the trait of numbers,
//! `functions`, `kernels`, `slopes` and `piecewise` are helpers, `literals` writes numbers and documentation.
//! [`statements`](crate::statements) decides the order of computation.

mod constants;
mod controllers;
mod emit;
mod expression;
mod functions;
mod generics;
mod jacobians;
mod kernels;
mod literals;
mod piecewise;
mod reactions;
mod regimes;
mod scalar;
mod signature;
mod slopes;
mod stages;
mod step;
mod types;
mod vectors;
mod words;

pub use crate::statements::EmitError;
pub use emit::{ITEMS_MODULE, Packaging, emit};
pub use vectors::{baked, vectors};

/// Returns true if a name is a valid identifier and not a reserved word of Rust.
pub fn is_identifier(name: &str) -> bool {
    words::WORDS.identifier(name).is_ok()
}
