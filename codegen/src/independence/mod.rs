//! Search for constraints that depend on each other, and rejection of constraints that have no effect or that no
//! state satisfies.
//!
//! `rows` evaluates the constraint derivatives with the program of `constraint_program`, `nodes` from graph nodes.
//! Both scale all entries of a row to one unit and implement the trait of `geometry`. `dependence` finds dependent
//! rows, `projection` finds states that satisfy the constraints, `check` finds dependent constraints, and `bounds`
//! rejects constraints that are never zero.

#[cfg(feature = "derive")]
pub(crate) mod bounds;
#[cfg(feature = "derive")]
mod check;
#[cfg(feature = "derive")]
pub mod constraint_program;
pub mod dependence;
#[cfg(feature = "derive")]
mod geometry;
#[cfg(feature = "derive")]
pub(crate) mod nodes;
#[cfg(feature = "derive")]
mod projection;
pub mod rows;
pub mod vectors;

#[cfg(feature = "derive")]
pub(crate) use check::find_redundancy;
