//! Derivation of the equations of motion from a checked model.
//!
//! - `translate` and `fields` translate expressions to nodes.
//! - `lagrange`, `sweeps`, `forces` and `kinetic` derive the rows of Lagrange's equations.
//! - `rigid_tree` derives inverse dynamics from frame to frame.
//! - `constraints`, `impacts` and `sliding` derive their terms; `solve` derives the accelerations.
//! - `coefficients` derives named coefficients as in Eq. (22).
//! - `equations` combines these; `outputs` derives additional functions on request.
//! - `jumps` finds the surfaces at which the energies jump; `corners` derives the jumps of the rates there.
//! - `linearity` tests linearity between switches; `sides` and `affine` derive the coefficients of such a
//!   model.
//! - `inertia` checks that every motion has inertia; `unsolved` translates a model without its equations.

pub mod affine;
pub mod coefficients;
pub(crate) mod constraints;
pub mod corners;
mod discs;
pub mod equations;
pub mod fields;
mod forces;
pub mod guard;
pub mod impacts;
pub(crate) mod inertia;
mod jumps;
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
