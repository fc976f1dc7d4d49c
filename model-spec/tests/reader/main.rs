//! Reading specifications: grammar, names, units, messages, edits.

mod broken;
mod controllers;
mod edits;
mod extension;
mod properties;
mod semantics;
mod shipped;
mod usual_notations;
