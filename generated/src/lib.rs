//! Equations of motion of the planetary arm, rigid and with one to eight modes. `eomgen generate --all`
//! writes the variants that `generated/family.toml` lists.

#![no_std]

mod variants;

pub use variants::*;
