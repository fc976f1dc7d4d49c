//! Studies of the program over many random machines and records. `.ci/run` holds a fixed sample
//! of each.

pub mod coverage;
pub mod grazing;
pub mod sample;
pub mod solvers;
