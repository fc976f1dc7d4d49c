//! Compares a model with measurements, finds what it lacks, names it and adds it.
//!
//! Data flows one way: [`model`] (a model that can be run and what is unknown of it, `beside`: its
//! part that is not linear); [`fit`] (estimates and what they leave);
//! [`catalogue`] (what may be missing, and where); [`residual_force`] (where a force is missing);
//! [`search`] (which effects are accepted); [`empirical`] (what is left and has no name);
//! [`report`] (for programs and for people). [`thresholds`] holds what decides.

pub mod catalogue;
pub mod empirical;
pub mod error;
pub mod fit;
pub mod model;
pub mod report;
pub mod residual_force;
pub mod search;
pub mod thresholds;

pub use report::result::{Comparison, Discovery};
pub use report::run::{Specification, compare, discover};
