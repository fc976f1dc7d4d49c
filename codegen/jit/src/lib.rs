//! Compilation of programs to machine code within the process, without an installed compiler. The results are
//! bit-identical to those of the interpreter and of the emitted Rust.
//!
//! ```
//! use eomgen_codegen::program::evaluator::{Evaluator, Point};
//! use eomgen_codegen::variant::Variant;
//! use eomgen_model_spec::source::Source;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = r#"
//! [model]
//! name = "oscillator"
//!
//! [parameters]
//! m = { value = 2, unit = "kg" }
//! k = { value = 50, unit = "N/m" }
//!
//! [coordinates]
//! x = { unit = "m" }
//!
//! [kinetic]
//! mass = "1/2*m*dot(x)^2"
//!
//! [potential]
//! spring = "1/2*k*x^2"
//! "#;
//! let model = eomgen_model_spec::check(Source::new("oscillator.toml", text))?.model;
//! let program = Variant::derive(&model, &[])?.program;
//!
//! // x and its rate, in m and m/s.
//! let state = [0.1, 0.3];
//! let point = Point { t: 0.0, state: &state, inputs: &[] };
//! let (mut compiled, mut interpreted) = ([0.0; 2], [0.0; 2]);
//! eomgen_jit::evaluator(program.clone()).rates(point, &mut compiled);
//! Evaluator::new(program).rates(point, &mut interpreted);
//! assert_eq!(compiled, interpreted);
//! assert!((compiled[1] + 2.5).abs() < 1e-15);
//! # Ok(())
//! # }
//! ```
//!
//! `compile` compiles a `Program`. `plan` divides a stage into functions of bounded length. `stage` writes the values
//! of a function and decides whether a value is stored in registers or in memory. `loops` writes loops over modes,
//! `elements` one or two elements of a vector, and `matrices` matrix operations. `functions` writes elementary
//! functions from their kernels; for scalars `branching` does so if `branches` finds long arms. `constants` collects
//! literals. `machine` compiles with Cranelift and owns the code.
//!
//! No operation is changed and no sum is reordered. An element has the same result in one lane and in two.

use std::sync::Arc;

use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, MachineCode};

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod branches;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod branching;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod constants;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod elements;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod functions;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod lanes;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod loops;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod machine;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod matrices;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod plan;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod stage;

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
pub use machine::{CompileError, Machine, compile};

/// Returns the machine code of a program, if this processor architecture is supported.
pub fn code(program: &Program) -> Option<Arc<dyn MachineCode>> {
    #[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
    if let Ok(machine) = compile(program) {
        return Some(Arc::new(machine));
    }
    let _ = program;
    None
}

/// Returns an evaluator that runs machine code if this processor architecture is supported, and interprets
/// otherwise. The results are equal.
pub fn evaluator(program: Program) -> Evaluator {
    match code(&program) {
        Some(code) => Evaluator::with_code(program, code),
        None => Evaluator::new(program),
    }
}
