//! The macro `eomgen::model!`: a specification, in a file or written in place, becomes the
//! items that `eomgen generate` would emit.
//!
//! The pipeline, one file each: `arguments` (which of the two forms), `tables` and `write` (the
//! sections in place to the text of a specification, `places` keeping the token that each
//! part of it came from), `expand` (through `model-spec` and `codegen` to items), `findings`
//! (what is wrong, at its token). No grammar of expressions and no list of sections is
//! here: sections in place are read by what reads a file.

mod arguments;
mod expand;
mod findings;
mod places;
mod tables;
#[cfg(test)]
mod tests;
mod write;

use proc_macro::TokenStream;

/// The items of a model. Documented where users meet it, in the crate `eomgen`.
#[proc_macro]
pub fn model(input: TokenStream) -> TokenStream {
    let root = std::env::var_os("CARGO_MANIFEST_DIR").map(std::path::PathBuf::from);
    expand::model(input.into(), root.as_deref()).into()
}
