//! Arguments of the macro: a file and an order, or sections.

use eomgen_codegen::mechanics::outputs::Output;
use proc_macro2::{Span, TokenStream};
use syn::parse::{Parse, ParseStream};
use syn::token::Brace;
use syn::{Error, Ident, LitInt, LitStr, Token, bracketed};

/// The arguments of the macro.
pub enum Arguments {
    /// `spec = "..."`, with the optional `order = ...` and `with = [...]`.
    File(LitStr, Option<Order>, Vec<Output>),
    /// `section { ... } ...`, not parsed yet, after the optional `with = [...]`.
    Sections(TokenStream, Vec<Output>),
}

/// Modal truncation order.
pub struct Order {
    /// The number of modes.
    pub value: usize,
    /// Token of the number.
    pub span: Span,
}

/// The two forms of a macro call, for messages.
const FORMS: &str = "write model! { spec = \"models/arm.toml\", order = 4 }, \
                     or sections such as model! { model { name: arm } kinetic { ... } }";

impl Parse for Arguments {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        if input.is_empty() {
            return Err(Error::new(
                Span::call_site(),
                format!("expected a specification\nhelp: {FORMS}"),
            ));
        }
        if input.peek(Ident) && input.peek2(Token![=]) {
            parse_file(input)
        } else if input.peek(LitStr) {
            let message = format!("expected `spec = ` before the path\nhelp: {FORMS}");
            Err(input.error(message))
        } else {
            Ok(Self::Sections(input.parse()?, Vec::new()))
        }
    }
}

/// Parses `spec = "...", order = ..., with = [...]` in any order. Sections may follow `with`.
fn parse_file(input: ParseStream<'_>) -> syn::Result<Arguments> {
    let begin = input.span();
    let (mut path, mut order, mut with) = (None, None, None);
    while !input.is_empty() {
        if let (None, None, Some(outputs), true) = (&path, &order, &with, input.peek2(Brace)) {
            let outputs = Vec::clone(outputs);
            return Ok(Arguments::Sections(input.parse()?, outputs));
        }
        let key: Ident = input
            .parse()
            .map_err(|error| Error::new(error.span(), "expected `spec = ...` or `order = ...`"))?;
        if !input.peek(Token![=]) {
            return Err(Error::new(
                key.span(),
                format!(
                    "expected `spec = ...` or `order = ...`\nhelp: write the sections in the file, or \
                     here without `spec` and `order`: {FORMS}"
                ),
            ));
        }
        input.parse::<Token![=]>()?;
        let repeated = match key.to_string().as_str() {
            "spec" => path.replace(parse_path(&key, input)?).is_some(),
            "order" => order.replace(parse_order(&key, input)?).is_some(),
            "with" => with.replace(parse_outputs(input)?).is_some(),
            _ => {
                let message = format!(
                    "unknown argument `{key}`\nhelp: the arguments are spec, order and with"
                );
                return Err(Error::new(key.span(), message));
            }
        };
        if repeated {
            return Err(Error::new(key.span(), format!("`{key}` is given twice")));
        }
        if !input.is_empty() {
            input
                .parse::<Token![,]>()
                .map_err(|error| Error::new(error.span(), "expected a comma"))?;
        }
    }
    match path {
        Some(path) => Ok(Arguments::File(path, order, with.unwrap_or_default())),
        None => Err(Error::new(
            begin,
            "`spec` is missing\nhelp: give spec = \"models/arm.toml\"; with sections here, set the \
             order in the field: fields { w: { order: 4, ... } }",
        )),
    }
}

/// Parses `[jacobians:states, products]`.
fn parse_outputs(input: ParseStream<'_>) -> syn::Result<Vec<Output>> {
    let list;
    bracketed!(list in input);
    let outputs = list.parse_terminated(parse_output, Token![,])?;
    Ok(outputs.into_iter().collect())
}

/// Parses `jacobians` or `jacobians:states`.
fn parse_output(input: ParseStream<'_>) -> syn::Result<Output> {
    let first: Ident = input.parse()?;
    let mut name = first.to_string();
    if input.peek(Token![:]) {
        input.parse::<Token![:]>()?;
        let part: Ident = input.parse()?;
        name += &format!(":{part}");
    }
    let known: Result<Output, _> = name.parse();
    known.map_err(|error| Error::new(first.span(), error.to_string()))
}

fn parse_path(key: &Ident, input: ParseStream<'_>) -> syn::Result<LitStr> {
    let place = value_span(key, input);
    input.parse().map_err(|_| {
        let message = "expected a path in quotes\nhelp: the path of a TOML file from the root of \
                       your crate, such as spec = \"models/arm.toml\"";
        Error::new(place, message)
    })
}

fn parse_order(key: &Ident, input: ParseStream<'_>) -> syn::Result<Order> {
    let place = value_span(key, input);
    let wrong = || {
        let most = eomgen_model_spec::model::MAX_ORDER;
        let message = format!(
            "the order is not a whole number\nhelp: give the number of modes, from 0 to {most}"
        );
        Error::new(place, message)
    };
    let literal: LitInt = input.parse().map_err(|_| wrong())?;
    let plain = literal.suffix().is_empty();
    match literal.base10_parse() {
        Ok(value) if plain => Ok(Order {
            value,
            span: literal.span(),
        }),
        _ => Err(wrong()),
    }
}

/// Returns the span of the token after a key, or the span of the key if no token follows.
fn value_span(key: &Ident, input: ParseStream<'_>) -> Span {
    if input.is_empty() {
        key.span()
    } else {
        input.span()
    }
}
