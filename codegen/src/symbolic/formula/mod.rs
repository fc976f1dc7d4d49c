//! Formulas for people, as trees: read off the graph once, then set as plain text or as
//! LaTeX. (As MathML they are set where pages are made.)
//!
//! The pipeline, one file each: `shared` (which shared nodes get lines of their own), `read`
//! (graph to tree), `tree`, `symbol` and `letters` (names as they are set), and a printer per notation,
//! `text` and `latex`. Sums over modes run over an index i; a node that has a name is
//! written by its name, except where its own formula is asked for.

mod latex;
mod letters;
mod read;
mod shared;
mod symbol;
mod text;
mod tree;

pub(crate) use latex::prose;
pub use letters::letter;
pub use read::{Reader, abridged, written_out};
pub use shared::Shared;
pub use symbol::{Index, Symbol};
pub use tree::{Choice, Formula, Level, MatrixPart, Term, powers_of_ten, small_fraction};
