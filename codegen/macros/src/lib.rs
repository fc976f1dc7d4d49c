//! The macro `eomgen::model!`: compiles a specification, in a file or in the macro's braces,
//! into the items that `eomgen generate` emits.
//!
//! Pipeline, one file per step: `arguments` (form of the call), `tables` and `write` (inline sections to the text of
//! a specification, with the token of every part kept in `places`), `expand` (from the text to items, by means of
//! `model-spec` and `codegen`), `findings` (errors and warnings at their tokens). This crate has no grammar of
//! expressions and sections: `model-spec` reads inline sections, too.

mod arguments;
mod expand;
mod findings;
mod places;
mod tables;
#[cfg(test)]
mod tests;
mod write;

use proc_macro::TokenStream;

/// Expands to the items of a model. The documentation for users is in the crate `eomgen`.
#[proc_macro]
pub fn model(input: TokenStream) -> TokenStream {
    let root = std::env::var_os("CARGO_MANIFEST_DIR").map(std::path::PathBuf::from);
    expand::model(input.into(), root.as_deref()).into()
}
