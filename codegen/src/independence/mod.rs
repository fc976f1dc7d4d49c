//! Rejection of constraints that depend on each other or that no state satisfies.
//!
//! `rows` evaluates the constraint derivatives with a program, `nodes` with graph nodes, both scaled to one
//! unit. `dependence` finds dependent rows, `projection` finds states that satisfy the constraints, `check`
//! rejects dependent constraints, and `bounds` rejects constraints that are never zero.

pub(crate) mod bounds;
mod check;
pub mod dependence;
pub(crate) mod nodes;
mod projection;
pub mod rows;
pub mod vectors;

pub(crate) use check::check_independence;
