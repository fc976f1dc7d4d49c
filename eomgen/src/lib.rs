//! Equations of motion from energies, at compile time.
#![no_std]

pub use eomgen_macros::model;
