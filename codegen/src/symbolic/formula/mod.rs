//! Formulas for people, as trees: read off the graph once, then set as plain text, as LaTeX or
//! as MathML.
//!
//! The pipeline, one file each: `shared` (which shared nodes get lines of their own), `read`
//! (graph to tree), `tree`, `symbol` and `letters` (names as they are set), and a printer per notation,
//! `text`, `latex` and `mathml`. Sums over modes run over an index i; a node that has a name is
//! written by its name, except where its own formula is asked for.

mod latex;
mod letters;
mod mathml;
mod read;
mod shared;
mod symbol;
mod text;
mod tree;

pub(crate) use latex::prose;
pub use mathml::number_element;
pub use read::{Reader, abridged, written_out};
pub use shared::Shared;
pub use symbol::{Index, Symbol};
pub use tree::{Choice, Formula, MatrixPart, Term};
