//! Engine of interactive pages: moves an exported model with the solvers of `eomgen simulate`, as a WebAssembly module
//! for `wasm32-unknown-unknown`.
//!
//! `boundary` exports the functions for scripts, with unsafe code; it is empty for other targets. `page_motion` is a motion
//! with its numbers for scripts, `signals` are inputs over time, and `module_code` calls the emitted modules of the
//! model's programs, which share the memory of the engine. The crate `page` compiles and embeds it.

#[cfg(target_family = "wasm")]
mod boundary;
mod module_code;
mod page_motion;
mod signals;

pub use module_code::{Array, ModuleCode, ModuleFunctions};
pub use page_motion::{PageMotion, Status};
pub use signals::{Form, SIGNAL_LENGTH, Signal};
