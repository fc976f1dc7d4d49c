//! WebAssembly backend: a module for browsers and other hosts, in double precision. Its results are bit-identical to
//! those of the emitted Rust, except for the sign and payload of NaN.
//!
//! `emit` assembles the module from its functions, memory and exports. `memory` is the layout of the arrays,
//! `functions` writes the helpers, `indices` numbers them. `code` is a function under construction; `expressions` and
//! `statements` add instructions to it. `names` lists reserved names. [`statements`](crate::statements) decides the
//! order of computation.

mod code;
mod emit;
mod expressions;
mod functions;
mod indices;
mod memory;
mod names;
mod statements;

pub use crate::statements::EmitError;
pub use emit::{EmittedModule, emit};
