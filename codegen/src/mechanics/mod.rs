//! From a checked model to its equations of motion.
//!
//! `translate` with `fields` (expressions to nodes), `lagrange`, `sweeps` and `forces` (the rows of
//! Lagrange's equations, of `rows`, `mass_matrix` and `guard`s), `kinetic` (the cheapest form of
//! those of a kinetic energy), `rigid_tree` (inverse dynamics from frame to frame), `constraints` (what stays zero),
//! `solve` (the accelerations), `impacts` (what impulses do),
//! `coefficients` (names as in Eq. (22)), `equations` (all of it), `outputs` (what is derived on
//! request), `linearity` (whether a model is linear between its switches), `sides` (switching functions
//! as polynomials), `affine` (the coefficients of a model that is linear between its switches), `sliding` (motion held on surfaces), `inertia` (whether all that moves has some), `unsolved` (a model without equations).

pub mod affine;
pub mod coefficients;
pub(crate) mod constraints;
pub mod equations;
pub mod fields;
mod forces;
pub mod guard;
pub mod impacts;
pub(crate) mod inertia;
mod kinetic;
mod lagrange;
pub mod linearity;
pub mod mass_matrix;
mod observed_rates;
pub mod outputs;
mod rigid_tree;
pub mod rows;
mod sides;
pub mod sliding;
pub mod solve;
mod sweeps;
pub mod translate;
pub(crate) mod unsolved;
