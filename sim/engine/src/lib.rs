//! Engine of interactive pages, a WebAssembly module for `wasm32-unknown-unknown`: it simulates an exported
//! model with the solvers of `eomgen simulate`.
//!
//! `boundary` exports the functions for scripts, with unsafe code; it is empty for other targets. `page_motion`
//! is a motion whose numbers scripts can read and write, `signals` are inputs as functions of time, and
//! `module_code` calls the emitted modules of the model's programs, which use the engine's memory. The crate
//! `page` compiles and embeds the engine.

#[cfg(target_family = "wasm")]
mod boundary;
mod module_code;
mod page_motion;
mod signals;

pub use module_code::{Array, ModuleCode, ModuleFunctions};
pub use page_motion::{PageMotion, Status};
pub use signals::{Form, SIGNAL_LENGTH, Signal};
