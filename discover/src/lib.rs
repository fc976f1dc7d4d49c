//! Compares a model with measurements, and finds what the model lacks.

pub mod bounded;
pub mod candidates;
pub mod catalogue;
pub mod dataset;
pub mod estimate;
pub mod gate;
pub mod plant;
pub mod rule;
pub mod shooting;
pub mod sites;
pub mod smooth;
pub mod starts;
pub mod unknowns;
pub mod windows;
