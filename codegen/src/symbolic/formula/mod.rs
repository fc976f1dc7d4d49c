//! Formulas for documents, as trees that are printed as plain text or LaTeX. (The page generator prints
//! MathML.)
//!
//! `shared` selects the shared nodes that get separate lines. `read` converts nodes to a `tree` of `symbol`s and
//! numbers, which `text` and `latex` print. Sums over modes have the index i. A named node is printed as its name,
//! except in its own formula.

mod latex;
mod letters;
mod read;
mod shared;
mod symbol;
mod text;
mod tree;

pub(crate) use latex::prose;
pub use letters::letter;
pub use read::{Reader, write_abridged_formula, write_full_formula};
pub use shared::SharedExpressions;
pub use symbol::{Index, Symbol};
pub use tree::{
    Choice, Formula, Level, MatrixPart, Term, find_multiple_of_pi, find_small_fraction,
    split_powers_of_ten,
};
