//! Compiles programs of equations of motion to machine code in this process, with no
//! compiler installed: the same bits as the interpreter and as emitted Rust.
//!
//! The pipeline, file by file: [`compile`] takes a `Program`; `stage` walks the values of
//! one stage and decides which live in registers and which in memory; `loops` writes loops
//! over modes; `elements` writes an element of a vector, or two neighbouring ones in one
//! register; `functions` the elementary functions from their kernels; `matrices` the
//! matrix operations; `constants` collects literals; `machine` hands all of it to Cranelift
//! and holds the code that comes back.
//!
//! No operation is changed and no sum reordered. Two lanes compute two elements of a
//! vector, each as it would be alone.

#![cfg_attr(
    not(any(target_arch = "x86_64", target_arch = "aarch64")),
    allow(unused)
)]

use codegen::evaluator::Evaluator;
use codegen::program::Program;

mod constants;
mod elements;
mod functions;
mod loops;
mod machine;
mod matrices;
mod stage;

pub use machine::{CompileError, Machine, compile};

/// An evaluator of a program that runs machine code where this machine's kind is known, and
/// interprets it elsewhere; the numbers are the same.
pub fn evaluator(program: Program) -> Evaluator {
    match compile(&program) {
        Ok(machine) => Evaluator::with_code(program, std::sync::Arc::new(machine)),
        Err(_) => Evaluator::new(program),
    }
}
