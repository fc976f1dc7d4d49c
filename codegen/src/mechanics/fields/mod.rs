//! Functions of the position along a field, and their integrals.
//!
//! `rule` selects the quadrature rule from the `degree` of integrands and the `breaks` of coefficients; `contents`
//! finds the quantities of an integrand. `resolution` checks the quadrature for given parameters.
//!
//! `term` and `function` define integrands as sums of terms. `moments` builds the nodes of their integrals, and
//! `domain` those of a field's interval. `mode`, `beam` and `spline` compute mode shapes; `modes` and `quadrature`
//! compute the tables of a basis.

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
