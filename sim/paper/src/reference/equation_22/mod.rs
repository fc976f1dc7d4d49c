//! The flexible arm: Eq. (22), assembled by hand for any truncation order S.
//!
//! [`coefficients`] computes a_01 .. a_78 under the paper's names and evaluates the
//! equations with the scale of each row; [`rates`] is the same in dimensionless form
//! with everything prepared once, without allocation, as a simulation would use it;
//! [`eliminated`] is the same motion at a cost of O(S), written for speed.

pub mod coefficients;
pub mod eliminated;
pub mod rates;

pub use coefficients::{Coefficients, ModeRow};
pub use eliminated::{Eliminated, copy_in_pairs};
pub use rates::Equation22;
