//! Sampled controllers from a shared library with a C interface, for `simulate --controller`.
//!
//! `library` checks the library and runs its controller; `interface` has the types of the C header
//! `examples/controllers/eomgen_controller.h` and contains all unsafe code.

mod interface;
mod library;

pub use library::{ControllerLibrary, LibraryError};

/// Version of the C interface.
pub const VERSION: u32 = 1;
