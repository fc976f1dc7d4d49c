//! Derivation of the equations of motion from a checked model.
//!
//! - `translate` and `fields` translate expressions to nodes.
//! - `lagrange`, `sweeps`, `forces` and `kinetic` derive the rows of Lagrange's equations.
//! - `rigid_tree` derives the inverse dynamics of rigid bodies recursively along the tree of frames.
//! - `constraints` and `redundancy`, `impacts` with `impact` and `workless_rates`, and `sliding` derive the terms of
//!   constraints, impacts and sliding; `solve` derives the accelerations.
//! - `coefficients` derives named coefficients as in Eq. (22) of the paper.
//! - `equations` combines these results; `outputs` derives additional functions on request.
//! - `jumps` finds the surfaces at which the energies jump; `corners` derives the quantities that determine the jumps
//!   of the rates.
//! - `linearity` tests linearity between switches; `sides` and `affine` derive the coefficients of a piecewise-linear
//!   model.
//! - `inertia` checks that every motion has inertia; `unsolved` translates a model without its equations.

#[cfg(feature = "derive")]
pub mod affine;
#[cfg(feature = "derive")]
pub mod coefficients;
#[cfg(feature = "derive")]
pub(crate) mod constraints;
#[cfg(feature = "derive")]
pub(crate) mod contributions;
#[cfg(feature = "derive")]
pub mod corners;
#[cfg(feature = "derive")]
mod discs;
#[cfg(feature = "derive")]
pub mod equations;
#[cfg(feature = "derive")]
pub mod fields;
#[cfg(feature = "derive")]
mod forces;
#[cfg(feature = "derive")]
mod function_rates;
#[cfg(feature = "derive")]
pub mod guard;
pub mod impact;
#[cfg(feature = "derive")]
pub(crate) mod impacts;
#[cfg(feature = "derive")]
pub(crate) mod inertia;
#[cfg(feature = "derive")]
mod jumps;
#[cfg(feature = "derive")]
mod kinetic;
#[cfg(feature = "derive")]
mod lagrange;
#[cfg(feature = "derive")]
pub mod linearity;
#[cfg(feature = "derive")]
pub mod mass_matrix;
#[cfg(feature = "derive")]
mod observed_rates;
pub mod outputs;
#[cfg(feature = "derive")]
pub mod redundancy;
#[cfg(feature = "derive")]
mod rigid_tree;
#[cfg(feature = "derive")]
pub mod rows;
#[cfg(feature = "derive")]
mod sides;
#[cfg(feature = "derive")]
pub mod sliding;
#[cfg(feature = "derive")]
pub mod solve;
#[cfg(feature = "derive")]
mod sweeps;
#[cfg(feature = "derive")]
pub mod translate;
#[cfg(feature = "derive")]
pub(crate) mod unsolved;
#[cfg(feature = "derive")]
mod workless_rates;
