//! Whether the constraints of a model are independent of each other.
//!
//! `rows` (their derivatives at a state, in a scale without units), `dependence` (which of them depend on
//! others), `projection` (states that keep them), `check` (refuses a model whose constraints depend on each
//! other wherever they hold).

mod check;
pub mod dependence;
mod projection;
pub mod rows;

pub(crate) use check::check;
