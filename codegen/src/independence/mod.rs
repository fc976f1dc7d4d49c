//! Whether the constraints of a model are independent of each other, and can hold.
//!
//! `rows` (their derivatives at a state, in a scale without units, by a program) and `nodes` (the same by
//! nodes), `dependence` (which of them depend on others), `projection` (states that keep them), `check`
//! (refuses a model whose constraints depend on each other wherever they hold), `bounds` (refuses constraints
//! that never hold).

pub(crate) mod bounds;
mod check;
pub mod dependence;
pub(crate) mod nodes;
mod projection;
pub mod rows;

pub(crate) use check::check_independence;
