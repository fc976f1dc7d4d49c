//! One file per command.

pub mod check;
pub mod derive;
pub mod generate;
pub mod simulate;
pub mod tour;
pub mod validate;
