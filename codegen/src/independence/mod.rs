//! Refusal of constraints that depend on each other or never hold.
//!
//! `rows` (their derivatives at a state, in a scale without units, by a program) and `nodes` (the same by
//! nodes), `vectors` (products and sizes),
//! `dependence` (which of them depend on others), `projection` (states that keep them), `check`
//! (refuses dependent constraints), `bounds` (refuses constraints that are never zero).

pub(crate) mod bounds;
mod check;
pub mod dependence;
pub(crate) mod nodes;
mod projection;
pub mod rows;
pub mod vectors;

pub(crate) use check::check_independence;
