//! Functions of the position along a field, and their integrals.
//!
//! `term` and `function` (integrands as sums of terms), `moments` (their integrals as nodes),
//! `domain` (where a field lives), `mode`, `beam` and `spline` (shapes), `modes` and `quadrature` (the numbers
//! of a basis).

mod beam;
pub mod domain;
pub mod function;
mod mode;
pub mod modes;
pub(crate) mod moments;
pub mod quadrature;
mod spline;
pub(crate) mod term;
