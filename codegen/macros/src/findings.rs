//! Reports the errors and warnings of `model-spec` as errors and warnings of the compiler.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, Label};
use proc_macro2::{Ident, Span, TokenStream};
use quote::{quote, quote_spanned};
use syn::Error;

use crate::places::PlacedText;

/// Converts the errors in inline sections to compiler errors at their tokens.
pub fn errors_at_tokens(found: &Diagnostics, placed: &PlacedText) -> Error {
    let mut errors = found.list().iter().map(|finding| {
        let text = message(finding, placed);
        match token_range(finding, placed) {
            // `new_spanned` joins the first and the last token.
            Some((first, last)) => {
                let (first, last) = (Ident::new("_a", first), Ident::new("_b", last));
                Error::new_spanned(quote!(#first #last), text)
            }
            None => Error::new(Span::call_site(), text),
        }
    });
    let nothing = || Error::new(Span::call_site(), "the specification has errors");
    let mut error = errors.next().unwrap_or_else(nothing);
    error.extend(errors);
    if found.omitted_count() > 0 {
        let more = format!("and {} more", found.omitted_count());
        error.combine(Error::new(Span::call_site(), more));
    }
    error
}

/// Converts the errors in a file to one compiler error at `place`. Its message contains the lines of the file.
pub fn error_in_file(found: &Diagnostics, place: Span) -> Error {
    let text = format!("the specification has errors\n\n{}", found.render(false));
    Error::new(place, text)
}

/// Returns statements that produce a compiler warning for each warning on inline sections.
pub fn warnings_at_tokens(found: &Diagnostics, placed: &PlacedText) -> TokenStream {
    let warnings = found.list().iter().map(|finding| {
        let (place, _) =
            token_range(finding, placed).unwrap_or((Span::call_site(), Span::call_site()));
        warning(&message(finding, placed), place)
    });
    quote!(#(#warnings)*)
}

/// Returns statements that produce one compiler warning for all warnings on a file.
pub fn warnings_in_file(found: &Diagnostics, place: Span) -> TokenStream {
    let texts = (!found.is_empty()).then(|| found.render(false));
    let warnings = texts.iter().map(|text| warning(text, place));
    quote!(#(#warnings)*)
}

/// Returns statements that use a deprecated constant. A procedural macro has no other means to emit a warning.
fn warning(text: &str, place: Span) -> TokenStream {
    let name = Ident::new("WARNING", place.resolved_at(Span::mixed_site()));
    let used = quote_spanned!(place=> #name);
    quote! {
        const _: () = {
            #[deprecated(note = #text)]
            const #name: () = ();
            #used
        };
    }
}

fn token_range(finding: &Diagnostic, placed: &PlacedText) -> Option<(Span, Span)> {
    let primary = finding.primary.as_ref()?;
    placed.token_range(primary.span)
}

/// Joins message, labels and help of a diagnostic, because the compiler underlines only the primary location.
fn message(finding: &Diagnostic, placed: &PlacedText) -> String {
    let mut text = finding.message.clone();
    let primary = finding.primary.iter().filter(|label| label.text != "here");
    for Label { text: remark, .. } in primary.filter(|label| !label.text.is_empty()) {
        text.push_str(&format!("\n{remark}"));
    }
    for Label { span, text: remark } in &finding.secondary {
        let shown = placed.token_text(*span).unwrap_or_default();
        text.push_str(&format!("\n`{shown}`: {remark}"));
    }
    if let Some(help) = &finding.help {
        text.push_str(&format!("\nhelp: {help}"));
    }
    text
}
