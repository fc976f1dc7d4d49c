//! One file per command.

pub mod check;
pub mod claims;
pub mod completions;
pub mod dataset;
pub mod derive;
pub mod discover;
pub mod family;
pub mod generate;
pub mod identify;
pub mod instructions;
pub mod linearise;
pub mod man;
pub mod merge;
pub mod modes;
pub mod page;
pub mod schema;
pub mod simulate;
pub mod study;
pub mod sweep;
pub mod tour;
pub mod trim;
pub mod validate;
pub mod verify;
