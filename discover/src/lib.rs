//! Compares a model with measurements, finds what it lacks, names it and adds it.
//!
//! Data flows one way: [`dataset`] (records with their description) and [`gate`] (whether they can
//! be believed); [`model`] (a model that can be run, windows, unknowns), run by [`march`]
//! (`beside`: what is not linear; `runge_kutta`: a step); [`fit`] (estimates and what they leave);
//! [`catalogue`] (what may be missing, and where); [`residual_force`] (where a force is missing);
//! [`search`] (which effects are accepted); [`empirical`] (what is left and has no name);
//! [`report`] (for programs and for people). [`thresholds`] holds what decides.

mod beside;
pub mod catalogue;
pub mod dataset;
pub mod empirical;
pub mod fit;
pub mod gate;
pub mod march;
pub mod model;
pub mod report;
pub mod residual_force;
mod runge_kutta;
pub mod search;
pub mod thresholds;
