//! From a checked model to equations of motion, and from these to programs and source.
//!
//! The pipeline, one file each: `translate`, `field_function` and `moments` (expressions to
//! the hash-consed `graph` of `operation`s (of `arguments`), whose constructors in `simplify` apply the
//! algebraic laws), `modes`, `tables` and `quadrature` (constants of a basis),
//! `differentiate` and `matrix` (derivatives that keep their structure), `lagrange`,
//! `forces` and `equations` (the equations of motion), `solve` (the accelerations),
//! `coefficients` (names as in Eq. (22)), `request` and `requested`, `jacobian`, `matrix_derivatives`,
//! `adjoint` and `regimes` (what is derived on request), `linearity` (whether a model is linear between its
//! switches), `inertia` (whether all that moves has some), `affine` (its matrices then), `lower` (to the `program`), `operations` (what it costs),
//! `evaluator` and `rust` (backends), `formula` and
//! `report` (for people).
//!
//! The arrows are two functions: [`equations::derive`] from a model to equations and
//! [`lower::lower`] from equations to a program; [`variant`] goes both.

mod adjoint;
pub mod affine;
mod arguments;
pub mod coefficients;
mod degree;
pub mod describe;
pub mod differentiate;
pub mod equations;
pub mod evaluator;
mod expand;
mod field_function;
mod forces;
pub mod formula;
pub mod graph;
mod inertia;
mod jacobian;
mod lagrange;
pub mod linearity;
pub mod lower;
pub mod matrix;
mod matrix_derivatives;
pub mod modes;
mod moments;
mod operation;
mod operations;
pub mod program;
pub mod quadrature;
pub mod regimes;
pub mod report;
pub mod request;
pub mod requested;
pub mod rust;
mod simplify;
pub mod solve;
mod substitute;
mod table_text;
pub mod tables;
pub mod translate;
pub mod variant;
