//! Sampled controllers.
//!
//! - `controller`: their interface
//! - `declared`: controllers of a specification
//! - `clock`: order of samples and output actions
//! - `memory`: values from which a motion continues
//! - `control_loop`: closed loop of controllers and motion
//! - `continued`: simulation over several calls
//! - `simulation`: simulation in one call

mod clock;
#[cfg(feature = "derive")]
mod continued;
mod control_loop;
mod controller;
mod declared;
mod memory;
#[cfg(feature = "derive")]
mod simulation;

pub use control_loop::ControlLoop;
pub(crate) use control_loop::{LoopRecord, Plant, limit_steps};
pub use controller::{Sample, SampledController};
pub use declared::DeclaredController;
pub use memory::{ControlMemory, NextSample, PendingOutputs};
