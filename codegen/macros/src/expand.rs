//! Expands the arguments of the macro to the items of a model, by means of `model-spec` and `codegen`.

use std::path::Path;

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::source::Source;
use proc_macro2::{Span, TokenStream};
use quote::quote;
use syn::{Error, LitStr};

use crate::arguments::{Arguments, Order};
use crate::findings::{error_in_file, errors_at_tokens, warnings_at_tokens, warnings_in_file};
use crate::tables::parse_sections;
use crate::write::write_specification;

/// File name of an inline specification in messages.
const INLINE_SOURCE_NAME: &str = "model!";

/// Returns the items of a model, or `compile_error!` for each error. Paths are relative to
/// `root`.
pub fn model(input: TokenStream, root: Option<&Path>) -> TokenStream {
    items(input, root).unwrap_or_else(Error::into_compile_error)
}

fn items(input: TokenStream, root: Option<&Path>) -> syn::Result<TokenStream> {
    match syn::parse2(input)? {
        Arguments::File(path, order, outputs) => expand_file(&path, order, &outputs, root),
        Arguments::Sections(stream, outputs) => expand_inline(stream, &outputs),
    }
}

fn expand_file(
    path: &LitStr,
    order: Option<Order>,
    outputs: &[Output],
    root: Option<&Path>,
) -> syn::Result<TokenStream> {
    let place = path.span();
    let root = root.ok_or_else(|| {
        let message = "CARGO_MANIFEST_DIR is not set, so the path cannot be resolved\n\
                       help: compile with cargo, or write the sections inside the macro";
        Error::new(place, message)
    })?;
    let written = path.value();
    let checked = eomgen_model_spec::load_from(root, Path::new(&written))
        .map_err(|found| file_error(&found, &root.join(&written), place))?;
    let model = checked.model;
    let orders = model.orders(order.as_ref().map(|order| order.value));
    let orders = orders.map_err(|error| {
        let place = order.as_ref().map_or(place, |order| order.span);
        Error::new(place, describe_error(&error))
    })?;
    let variant = Variant::derive_with(&model, &orders, outputs)
        .map_err(|found| error_in_file(&found, place))?;
    let items = emit_items(&variant)?;
    let warnings = warnings_in_file(&checked.warnings, place);
    let paths: Option<Vec<String>> = model
        .files()
        .iter()
        .map(|file| root.join(file).to_str().map(str::to_owned))
        .collect();
    let Some(paths) = paths else {
        return Err(Error::new(place, "the path of the file is not Unicode"));
    };
    Ok(quote! {
        #items
        #warnings
        // Registers the files as dependencies: the compiler expands again when one changes.
        #(const _: &[u8] = ::core::include_bytes!(#paths);)*
    })
}

fn file_error(found: &Diagnostics, path: &Path, place: Span) -> Error {
    match found.list().first() {
        Some(unreadable) if !path.is_file() => Error::new(
            place,
            format!(
                "{}\nhelp: the path is relative to the root of the crate, the folder of its Cargo.toml",
                unreadable.message
            ),
        ),
        _ => error_in_file(found, place),
    }
}

fn expand_inline(stream: TokenStream, outputs: &[Output]) -> syn::Result<TokenStream> {
    let placed = write_specification(&parse_sections(stream)?)?;
    let source = Source::new(INLINE_SOURCE_NAME, placed.text.as_str());
    let checked =
        eomgen_model_spec::check(source).map_err(|found| errors_at_tokens(&found, &placed))?;
    let model = checked.model;
    let orders = model
        .orders(None)
        .map_err(|error| Error::new(Span::call_site(), describe_error(&error)))?;
    let variant = Variant::derive_with(&model, &orders, outputs)
        .map_err(|found| errors_at_tokens(&found, &placed))?;
    let items = emit_items(&variant)?;
    let warnings = warnings_at_tokens(&checked.warnings, &placed);
    let text = &placed.text;
    Ok(quote! {
        #items
        #warnings
        #[doc = " Text of the specification, as TOML. Saved to a file, every command of `eomgen` accepts it."]
        pub const SPECIFICATION: &'static str = #text;
    })
}

fn emit_items(variant: &Variant) -> syn::Result<TokenStream> {
    let failed = |message: String| Error::new(Span::call_site(), message);
    emit(&variant.program, Packaging::Items)
        .map_err(|error| failed(error.to_string()))?
        .parse()
        .map_err(|error: proc_macro2::LexError| failed(error.to_string()))
}

fn describe_error(error: &eomgen_model_spec::variant::ModelError) -> String {
    match &error.help {
        Some(help) => format!("{}\nhelp: {help}", error.message),
        None => error.message.clone(),
    }
}
