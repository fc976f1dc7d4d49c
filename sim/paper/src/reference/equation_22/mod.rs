//! Flexible arm: Eq. (22), assembled by hand for any truncation order S.
//!
//! [`coefficients`] computes a_01 .. a_78 and evaluates the equations with the scale of each row.
//! [`rates`] is the same in dimensionless form, prepared once and without allocation, as for a
//! simulation. [`eliminated`] is the same motion at a cost of O(S), written for speed.

pub mod coefficients;
pub mod eliminated;
pub mod rates;

pub use coefficients::{Coefficients, ModeRow};
pub use eliminated::{EliminatedArm, copy_in_pairs};
pub use rates::Equation22;
