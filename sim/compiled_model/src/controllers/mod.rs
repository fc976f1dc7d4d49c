//! Sampled controllers: `controller` is their interface, `declared` those of a specification, `clock` the order of samples
//! and actions, `simulation` the motion with controllers.

mod clock;
mod controller;
mod declared;
mod simulation;

pub use controller::{Sample, SampledController};
pub use declared::DeclaredController;
