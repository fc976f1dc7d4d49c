//! Functions of the position along a field, and their integrals.
//!
//! `term` and `function` define integrands as sums of terms, `moments` their integrals as nodes, `domain` the
//! interval of a field. `mode`, `beam` and `spline` compute shapes, `modes` and `quadrature` the tables of a
//! basis.

mod beam;
pub mod domain;
pub mod function;
mod mode;
pub mod modes;
pub(crate) mod moments;
pub mod quadrature;
mod spline;
pub(crate) mod term;
