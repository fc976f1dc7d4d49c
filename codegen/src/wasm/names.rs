//! Names within a stage: its arrays and loop variables. They do not occur in the module.

use crate::statements::Words;

/// Rules for names. A module has no keywords.
pub(super) const WORDS: Words = Words {
    language: "WebAssembly",
    keywords: "",
    taken: "t state inputs parameters coefficients rates values observables i j k",
    prefixed: false,
};
