//! Functions of the position along a field, and their integrals.
//!
//! `rule` is the quadrature rule, by the `degree` of integrals and the `breaks` of coefficients, which depend on the
//! `contents` of integrands. `resolution` checks the quadrature at values of the parameters.
//!
//! `term` and `function` define integrands as sums of terms, `moments` their integrals as nodes, `domain` the
//! interval of a field. `mode`, `beam` and `spline` compute shapes, `modes` and `quadrature` the tables of a
//! basis.

mod beam;
mod breaks;
mod contents;
mod degree;
pub mod domain;
pub mod function;
mod mode;
pub mod modes;
pub(crate) mod moments;
pub mod quadrature;
pub mod resolution;
pub mod rule;
mod spline;
pub(crate) mod term;
