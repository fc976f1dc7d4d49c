//! C interface of the library: motions of specifications and their gradients. The header `include/eomgen_simulation.h`
//! describes the functions.
//!
//! [`interface`] exports the functions and converts pointers, [`model`] simulates.

pub mod interface;
pub mod model;
