//! Derivation of equations of motion from a checked model, and their output as programs and source code.
//!
//! ```
//! use eomgen_codegen::program::evaluator::{Evaluator, Point};
//! use eomgen_codegen::rust::{Packaging, emit};
//! use eomgen_codegen::variant::Variant;
//! use eomgen_model_spec::source::Source;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = r#"
//! [model]
//! name = "pendulum"
//!
//! [parameters]
//! m = { value = 0.15, unit = "kg" }
//! l = { value = 0.3, unit = "m" }
//! g = { value = 9.81, unit = "m/s^2" }
//!
//! [coordinates]
//! theta = { unit = "rad" }
//!
//! [kinetic]
//! bob = "1/2*m*(l*dot(theta))^2"
//!
//! [potential]
//! gravity = "-m*g*l*cos(theta)"
//! "#;
//! let model = eomgen_model_spec::check(Source::new("pendulum.toml", text))?.model;
//!
// The second argument lists the order of each field; a pendulum has no fields.
//! let variant = Variant::derive(&model, &[])?;
//!
//! // The rates of the state (theta, theta_dot), in rad/s and rad/s^2.
//! let mut evaluator = Evaluator::new(variant.program.clone());
//! let (state, mut rates) = ([0.5, 0.0], [0.0; 2]);
//! evaluator.rates(Point { t: 0.0, state: &state, inputs: &[] }, &mut rates);
//! assert_eq!(rates[0], 0.0);
//! assert!((rates[1] + 9.81 / 0.3 * 0.5_f64.sin()).abs() < 1e-12);
//!
// Emits the equations as a source file without dependencies.
//! let file = emit(&variant.program, Packaging::Crate)?;
//! assert!(file.contains("pub fn rates<T: Scalar>("));
//! # Ok(())
//! # }
//! ```
//!
//! Five stages, one folder each. A stage uses only the stages above it:
//!
//! 1. [`symbolic`]: expressions as nodes of one hash-consed graph, their simplification,
//!    derivatives and formulas;
//! 2. [`mechanics`]: equations of motion of a model, [`mechanics::equations::derive`];
//! 3. [`program`]: the equations as a list of values in static single assignment,
//!    [`program::lowering::lower`], and their evaluation;
//! 4. [`statements`]: the statements of each emitted function, with loops and names;
//! 5. [`rust`] and [`c`] (emitted source), [`wasm`] (a module for browsers) and [`report`] (equations as text
//!    and LaTeX).
//!
//! `trace` lists, for each value of a program, the terms of the specification that contribute to it; emitted source
//! prints them in comments. [`vectors`] computes test vectors, which the backends write next to the source.
//!
//! [`rounding`] bounds the rounding errors of a program over ranges of its variables. [`variant`] derives the program
//! of a model in one call and finds dependent constraints ([`independence`]). [`examination`] checks a model without
//! deriving its equations and finds most errors. [`singular_terms`] finds terms that are not differentiable at a
//! point.

#[cfg(feature = "derive")]
pub mod c;
#[cfg(feature = "derive")]
pub mod examination;
#[cfg(feature = "derive")]
pub mod identity;
pub mod independence;
pub mod mechanics;
pub mod program;
#[cfg(feature = "derive")]
pub mod report;
#[cfg(feature = "derive")]
pub mod rounding;
#[cfg(feature = "derive")]
pub mod rust;
#[cfg(feature = "derive")]
pub mod singular_terms;
pub mod stable_hash;
#[cfg(feature = "derive")]
pub mod statements;
pub mod symbolic;
#[cfg(feature = "derive")]
pub mod trace;
#[cfg(feature = "derive")]
pub mod variant;
#[cfg(feature = "derive")]
pub mod vectors;
#[cfg(feature = "derive")]
pub mod wasm;
