//! Names within a stage: the arrays that it is given and writes to, and the variables of loops.
//! A module in WebAssembly shows none of them.

use crate::statements::Words;

/// What names of the model have to leave to the stages. Names of a module may be any text, so that
/// nothing is a keyword.
pub(super) const WORDS: Words = Words {
    language: "WebAssembly",
    keywords: &[],
    taken: &[
        "t",
        "state",
        "inputs",
        "parameters",
        "coefficients",
        "rates",
        "values",
        "observables",
        "i",
        "j",
        "k",
    ],
    prefixed: false,
};
