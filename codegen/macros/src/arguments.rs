//! What stands in the brackets of the macro: a file and an order, or sections. What the
//! sections hold is the business of `tables`.

use proc_macro2::{Span, TokenStream};
use syn::parse::{Parse, ParseStream};
use syn::{Error, Ident, LitInt, LitStr, Token};

/// The arguments of the macro.
pub enum Arguments {
    /// `spec = "..."`, and `order = ...` if it is given.
    File(LitStr, Option<Order>),
    /// `section { ... } ...`, not looked at yet.
    Sections(TokenStream),
}

/// A modal truncation order.
pub struct Order {
    /// The number.
    pub value: usize,
    /// Where it stands.
    pub span: Span,
}

/// What the macro takes, for a message.
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
            file(input)
        } else if input.peek(LitStr) {
            let message = format!("expected `spec = ` before the path\nhelp: {FORMS}");
            Err(input.error(message))
        } else {
            input.parse().map(Self::Sections)
        }
    }
}

/// `spec = "...", order = ...` in any order.
fn file(input: ParseStream<'_>) -> syn::Result<Arguments> {
    let begin = input.span();
    let (mut path, mut order) = (None, None);
    while !input.is_empty() {
        let key: Ident = input
            .parse()
            .map_err(|error| Error::new(error.span(), "expected `spec = ...` or `order = ...`"))?;
        if !input.peek(Token![=]) {
            return Err(Error::new(
                key.span(),
                format!(
                    "expected `spec = ...` or `order = ...`\nhelp: sections stand in the file, or \
                     in place and without `spec` and `order`: {FORMS}"
                ),
            ));
        }
        input.parse::<Token![=]>()?;
        let repeated = match key.to_string().as_str() {
            "spec" => path.replace(path_after(&key, input)?).is_some(),
            "order" => order.replace(order_after(&key, input)?).is_some(),
            _ => {
                let message = format!("unknown argument `{key}`\nhelp: known are spec and order");
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
        Some(path) => Ok(Arguments::File(path, order)),
        None => Err(Error::new(
            begin,
            "an order without a file\nhelp: give spec = \"models/arm.toml\"; in sections, the \
             order stands with the field: fields { w: { order: 4, ... } }",
        )),
    }
}

fn path_after(key: &Ident, input: ParseStream<'_>) -> syn::Result<LitStr> {
    let place = place(key, input);
    input.parse().map_err(|_| {
        let message = "expected a path in quotes\nhelp: the path of a TOML file from the root of \
                       your crate, such as spec = \"models/arm.toml\"";
        Error::new(place, message)
    })
}

fn order_after(key: &Ident, input: ParseStream<'_>) -> syn::Result<Order> {
    let place = place(key, input);
    let wrong = || {
        let most = model_spec::model::MAX_ORDER;
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

/// Where the value of a key stands; the key if there is none.
fn place(key: &Ident, input: ParseStream<'_>) -> Span {
    if input.is_empty() {
        key.span()
    } else {
        input.span()
    }
}
