//! The WebAssembly backend: a module that imports nothing, for browsers and whatever else runs
//! WebAssembly, with the bits of the emitted Rust in double precision. (Only the sign and payload of
//! NaN are left open, as everywhere.)
//!
//! `emit` makes the module: its functions, its memory and what it exports. `memory` says where every
//! array stands, `functions` are the helpers that stages call, elementary functions from their
//! kernels among them, and `indices` their numbers. `code` is one function being written,
//! `expressions`, `statements` and `cholesky` write into it; `names` are the words that stages keep
//! for themselves. What is computed in which order comes from [`statements`](crate::statements).

mod cholesky;
mod code;
mod emit;
mod expressions;
mod functions;
mod indices;
mod memory;
mod names;
mod statements;

pub use crate::statements::EmitError;
pub use emit::emit;
