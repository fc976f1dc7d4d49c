//! Studies of the program with many random machines and records. `.ci/run` runs a fixed sample of each study.

pub mod alarms;
pub mod bounds;
pub mod contacts;
pub mod coverage;
pub mod gradients;
pub mod grazing;
pub mod hosts;
pub mod mutations;
pub mod sample;
pub mod solvers;
