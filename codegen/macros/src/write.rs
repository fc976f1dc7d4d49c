//! Writes the tables of a macro as the text of a specification. The text and its hash do not depend on the spacing of
//! the tokens.

use proc_macro2::{Delimiter, Group, Ident, Span, TokenTree};
use syn::Error;

use crate::places::PlacedText;
use crate::tables::{Entry, MAX_DEPTH, Table, Value};

/// Writes these sections as a specification.
///
/// # Errors
/// An expression with brackets nested deeper than [`MAX_DEPTH`].
pub fn write_specification(sections: &[Entry]) -> syn::Result<PlacedText> {
    let mut placed = PlacedText::default();
    for (index, section) in sections.iter().enumerate() {
        placed.push(if index == 0 { "[" } else { "\n[" });
        write_key(&mut placed, &section.key);
        placed.push("]\n");
        let Value::Table(table) = &section.value else {
            continue;
        };
        for entry in &table.entries {
            self::write_entry(&mut placed, entry)?;
            placed.push("\n");
        }
    }
    Ok(placed)
}

fn write_entry(placed: &mut PlacedText, entry: &Entry) -> syn::Result<()> {
    write_key(placed, &entry.key);
    placed.push(" = ");
    match &entry.value {
        Value::Table(inline) => write_table(placed, inline),
        Value::Text(text) => {
            placed.push_token(&format!("\"{}\"", escape(&text.value())), text.span());
            Ok(())
        }
        Value::Tokens(tokens) => match tokens.as_slice() {
            [TokenTree::Group(group)] if is_array(group) => write_array(placed, group),
            tokens => write_expression(placed, tokens),
        },
    }
}

fn is_comma(token: &TokenTree) -> bool {
    matches!(token, TokenTree::Punct(mark) if mark.as_char() == ',')
}

/// Returns true if brackets contain a comma. Otherwise they are part of an expression, and the
/// parser of expressions reports errors in them.
fn is_array(group: &Group) -> bool {
    let several = || group.stream().into_iter().any(|token| is_comma(&token));
    group.delimiter() == Delimiter::Bracket && several()
}

/// Writes values between brackets, for example the ends of a range.
fn write_array(placed: &mut PlacedText, group: &Group) -> syn::Result<()> {
    placed.push_token("[", group.span_open());
    let tokens: Vec<TokenTree> = group.stream().into_iter().collect();
    let mut elements: Vec<&[TokenTree]> = tokens.split(is_comma).collect();
    // A trailing comma leaves an empty element.
    if elements.last().is_some_and(|element| element.is_empty()) {
        elements.pop();
    }
    for (index, element) in elements.into_iter().enumerate() {
        placed.push(if index == 0 { "" } else { ", " });
        write_expression(placed, element)?;
    }
    placed.push_token("]", group.span_close());
    Ok(())
}

fn write_table(placed: &mut PlacedText, table: &Table) -> syn::Result<()> {
    placed.push_token("{", table.open);
    for (index, entry) in table.entries.iter().enumerate() {
        placed.push(if index == 0 { " " } else { ", " });
        self::write_entry(placed, entry)?;
    }
    placed.push(" ");
    placed.push_token("}", table.close);
    Ok(())
}

/// Writes a name, quoted if TOML does not allow its letters in a bare key.
fn write_key(placed: &mut PlacedText, key: &Ident) {
    let name = key.to_string();
    let bare = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    if name.bytes().all(bare) {
        placed.push_token(&name, key.span());
    } else {
        placed.push_token(&format!("\"{}\"", escape(&name)), key.span());
    }
}

/// Writes a number unchanged, and any other expression in quotes.
fn write_expression(placed: &mut PlacedText, tokens: &[TokenTree]) -> syn::Result<()> {
    let mut pieces = Vec::new();
    for token in tokens {
        split_token(token, 1, &mut pieces)?;
    }
    let quote = if is_number(&pieces) { "" } else { "\"" };
    placed.push(quote);
    for (index, piece) in pieces.iter().enumerate() {
        let apart = index > 0 && pieces[index - 1].is_word && (piece.is_word || piece.text == ".");
        placed.push(if apart { " " } else { "" });
        placed.push_token(&escape(&piece.text), piece.span);
        // No space is added after a trailing comma.
        let goes_on = index + 1 < pieces.len();
        placed.push(if goes_on && piece.text == "," {
            " "
        } else {
            ""
        });
    }
    // The quote has no token: an error at the end of the expression is reported at the last token.
    placed.push(quote);
    Ok(())
}

/// Rust token; each bracket is a separate piece.
struct Piece {
    text: String,
    /// True for a name or a literal. A space is needed between two of these.
    is_word: bool,
    span: Span,
}

fn split_token(token: &TokenTree, depth: usize, pieces: &mut Vec<Piece>) -> syn::Result<()> {
    let mut add = |text: String, word: bool, span: Span| {
        pieces.push(Piece {
            text,
            is_word: word,
            span,
        })
    };
    let group = match token {
        TokenTree::Group(group) => group,
        TokenTree::Punct(mark) => {
            add(mark.as_char().to_string(), false, mark.span());
            return Ok(());
        }
        word => {
            add(word.to_string(), true, word.span());
            return Ok(());
        }
    };
    if depth > MAX_DEPTH {
        let message = format!("the expression has more than {MAX_DEPTH} nested levels");
        return Err(Error::new(group.span_open(), message));
    }
    let (open, close) = match group.delimiter() {
        Delimiter::Parenthesis => ("(", ")"),
        Delimiter::Bracket => ("[", "]"),
        Delimiter::Brace => ("{", "}"),
        Delimiter::None => ("", ""),
    };
    add(open.to_owned(), false, group.span_open());
    for inner in group.stream() {
        split_token(&inner, depth + 1, pieces)?;
    }
    pieces.push(Piece {
        text: close.to_owned(),
        is_word: false,
        span: group.span_close(),
    });
    Ok(())
}

/// Returns true if the pieces form a TOML number: a sign, digits, an optional fraction and an optional exponent. `2.`
/// and `.5` are not valid in TOML, but valid in expressions.
fn is_number(pieces: &[Piece]) -> bool {
    let literal = match pieces {
        [literal] => literal,
        [sign, literal] if matches!(sign.text.as_str(), "+" | "-") => literal,
        _ => return false,
    };
    let text = literal.text.strip_prefix('-').unwrap_or(&literal.text);
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, Some(exponent)),
        None => (text, None),
    };
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let (whole, fraction) = match mantissa.split_once('.') {
        Some((whole, fraction)) => (whole, Some(fraction)),
        None => (mantissa, None),
    };
    let unsigned = |text: &str| digits(text.strip_prefix(['+', '-']).unwrap_or(text));
    digits(whole)
        && (whole == "0" || !whole.starts_with('0'))
        && fraction.is_none_or(digits)
        && exponent.is_none_or(unsigned)
}

/// Escapes text for a TOML string.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '"' | '\\' => escaped.extend(['\\', letter]),
            letter if letter.is_control() => {
                escaped.push_str(&format!("\\u{:04X}", u32::from(letter)));
            }
            letter => escaped.push(letter),
        }
    }
    escaped
}
