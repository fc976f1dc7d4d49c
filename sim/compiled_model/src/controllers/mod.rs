//! Sampled controllers: `controller` is their interface, `declared` those of a specification, `clock` the order of
//! samples and actions, `memory` the values with which another motion continues, `control_loop` the loop of controllers
//! with a motion, `continued` a simulation with controllers from call to call, `simulation` a whole one.

mod clock;
#[cfg(feature = "derive")]
mod continued;
mod control_loop;
mod controller;
mod declared;
mod memory;
#[cfg(feature = "derive")]
mod simulation;

pub(crate) use control_loop::{ControlLoop, LoopRecord, Plant, limit_steps};
pub use controller::{Sample, SampledController};
pub use declared::DeclaredController;
pub use memory::{ControlMemory, NextSample, PendingOutputs};
