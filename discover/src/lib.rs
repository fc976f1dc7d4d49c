//! Compares a model with measurements, and finds what the model lacks.

pub mod bounded;
pub mod candidates;
pub mod catalogue;
pub mod dataset;
pub mod document;
pub mod estimate;
pub mod extend;
pub mod fitting;
pub mod floor;
pub mod gate;
pub mod judge;
pub mod locate;
pub mod plant;
pub mod report;
pub mod rule;
pub mod screen;
pub mod search;
pub mod shooting;
pub mod sites;
pub mod smooth;
pub mod starts;
pub mod unknowns;
pub mod windows;
