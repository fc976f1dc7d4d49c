//! Numbers, names and documentation as tokens. Text from a specification passes through
//! here and nowhere else: names are parsed as identifiers, prose becomes a string literal.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::EmitError;

/// A number with all its bits, in the shorter of the two usual notations.
pub fn number(value: f64) -> TokenStream {
    if value.is_nan() {
        return quote!(f64::NAN);
    }
    if value.is_infinite() {
        return if value > 0.0 {
            quote!(f64::INFINITY)
        } else {
            quote!(f64::NEG_INFINITY)
        };
    }
    let magnitude = value.abs();
    let plain = magnitude == 0.0 || (1e-4..1e7).contains(&magnitude);
    let text = if plain {
        format!("{magnitude:?}")
    } else {
        format!("{magnitude:e}")
    };
    let literal: Literal = text
        .parse()
        .unwrap_or_else(|_| Literal::f64_unsuffixed(magnitude));
    if value.is_sign_negative() {
        quote!(-#literal)
    } else {
        quote!(#literal)
    }
}

/// An identifier, if the name is one.
pub fn identifier(name: &str) -> Result<Ident, EmitError> {
    syn::parse_str(name).map_err(|_| EmitError::Name(name.to_owned()))
}

/// A count.
pub fn count(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}

/// Documentation of the item that follows, one attribute per line.
pub fn doc(lines: &[String]) -> TokenStream {
    let attributes = lines.iter().map(|line| {
        let line = single_line(line);
        quote!(#[doc = #line])
    });
    quote!(#(#attributes)*)
}

/// Documentation of the file.
pub fn file_doc(lines: &[String]) -> TokenStream {
    let attributes = lines.iter().map(|line| {
        let line = single_line(line);
        quote!(#![doc = #line])
    });
    quote!(#(#attributes)*)
}

/// Without control characters and without those that turn the direction of the text, which
/// rustc refuses, with a space in front as in a written comment, and with
/// brackets that rustdoc would take for links or tags defused.
fn single_line(text: &str) -> String {
    let clean: String = text
        .chars()
        .map(|c| match c {
            '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => ' ',
            c if c.is_control() => ' ',
            c => c,
        })
        .collect();
    let clean = clean.replace('[', "\\[").replace('<', "\\<");
    if clean.is_empty() {
        clean
    } else {
        format!(" {clean}")
    }
}
