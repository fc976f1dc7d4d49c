//! Parses tokens as tables: `name { entry, ... }`, and within it `name: value`
//! or `name = value`. The names and the values are checked later, by `model-spec`.

use proc_macro2::{Delimiter, Group, Ident, Spacing, Span, TokenStream, TokenTree};
use syn::{Error, LitStr};

/// Deepest nesting of braces and brackets that is accepted; later steps recurse over the nesting.
pub const MAX_DEPTH: usize = 200;

/// A name and its value.
pub struct Entry {
    /// The name.
    pub key: Ident,
    /// The value.
    pub value: Value,
}

/// Value of an entry.
pub enum Value {
    /// `{ entry, ... }`
    Table(Table),
    /// A string literal.
    Text(LitStr),
    /// Anything else, at least one token.
    Tokens(Vec<TokenTree>),
}

/// Entries between two braces.
pub struct Table {
    /// The opening brace.
    pub open: Span,
    /// The entries, in the order of the tokens.
    pub entries: Vec<Entry>,
    /// The closing brace.
    pub close: Span,
}

/// Parses the sections of a specification.
///
/// # Errors
/// The first token that does not fit the grammar.
pub fn parse_sections(stream: TokenStream) -> syn::Result<Vec<Entry>> {
    let mut tokens = flatten_groups(stream).into_iter().peekable();
    let mut sections = Vec::new();
    while let Some(token) = tokens.next() {
        let key = match token {
            TokenTree::Ident(key) => key,
            TokenTree::Punct(mark) if matches!(mark.as_char(), ',' | ';') => {
                let message = "unexpected separator between sections\nhelp: remove it";
                return Err(Error::new(mark.span(), message));
            }
            other => {
                let message = "expected a section\nhelp: for example kinetic { ... }";
                return Err(Error::new(other.span(), message));
            }
        };
        match tokens.next() {
            Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
                let value = Value::Table(parse_table(&group, 1)?);
                add_entry(&mut sections, Entry { key, value })?;
            }
            other => {
                let place = other.map_or(key.span(), |token| token.span());
                let message = format!("expected braces after `{key}`\nhelp: {key} {{ ... }}");
                return Err(Error::new(place, message));
            }
        }
    }
    Ok(sections)
}

/// Removes the invisible groups that an outer macro puts around its arguments.
fn flatten_groups(stream: TokenStream) -> Vec<TokenTree> {
    let mut tokens = Vec::new();
    for token in stream {
        match token {
            TokenTree::Group(group) if group.delimiter() == Delimiter::None => {
                tokens.extend(flatten_groups(group.stream()));
            }
            other => tokens.push(other),
        }
    }
    tokens
}

fn parse_table(group: &Group, depth: usize) -> syn::Result<Table> {
    if depth > MAX_DEPTH {
        let message = format!("braces are nested more than {MAX_DEPTH} deep");
        return Err(Error::new(group.span_open(), message));
    }
    let tokens = flatten_groups(group.stream());
    let mut entries = Vec::new();
    let mut rest: &[TokenTree] = &tokens;
    while !rest.is_empty() {
        let (key, behind) = parse_key(rest)?;
        let length = behind
            .iter()
            .position(is_punctuation(','))
            .unwrap_or(behind.len());
        let value = parse_value(&key, &behind[..length], depth)?;
        add_entry(&mut entries, Entry { key, value })?;
        rest = behind.get(length + 1..).unwrap_or_default();
    }
    Ok(Table {
        open: group.span_open(),
        entries,
        close: group.span_close(),
    })
}

fn is_punctuation(wanted: char) -> impl Fn(&TokenTree) -> bool {
    move |token| matches!(token, TokenTree::Punct(mark) if mark.as_char() == wanted)
}

/// Splits an entry into its key and the tokens after the colon.
fn parse_key(tokens: &[TokenTree]) -> syn::Result<(Ident, &[TokenTree])> {
    match tokens {
        [TokenTree::Ident(key), colon, rest @ ..]
            if is_punctuation(':')(colon) || is_punctuation('=')(colon) =>
        {
            Ok((key.clone(), rest))
        }
        [TokenTree::Ident(key), rest @ ..] => {
            let place = rest.first().map_or(key.span(), TokenTree::span);
            let message = format!("expected `:` after `{key}`\nhelp: {key}: ...");
            Err(Error::new(place, message))
        }
        [first, ..] if is_punctuation('#')(first) => Err(Error::new(
            first.span(),
            "expected a name\nhelp: a comment begins with //; documentation is an entry's \
             doc: \"...\"",
        )),
        [first, ..] => Err(Error::new(first.span(), "expected a name")),
        [] => Err(Error::new(Span::call_site(), "expected a name")),
    }
}

fn parse_value(key: &Ident, tokens: &[TokenTree], depth: usize) -> syn::Result<Value> {
    match tokens {
        [] => {
            let message = format!("`{key}` has no value");
            Err(Error::new(key.span(), message))
        }
        [TokenTree::Group(group)] if group.delimiter() == Delimiter::Brace => {
            Ok(Value::Table(parse_table(group, depth + 1)?))
        }
        [TokenTree::Literal(literal)] => {
            let single = TokenStream::from(TokenTree::from(literal.clone()));
            Ok(match syn::parse2(single) {
                Ok(text) => Value::Text(text),
                Err(_) => Value::Tokens(tokens.to_vec()),
            })
        }
        _ => {
            reject_two_entries(tokens)?;
            Ok(Value::Tokens(tokens.to_vec()))
        }
    }
}

/// Rejects a value that contains `name:`, the start of the next entry.
fn reject_two_entries(tokens: &[TokenTree]) -> syn::Result<()> {
    for (index, token) in tokens.iter().enumerate().skip(1) {
        let TokenTree::Punct(mark) = token else {
            continue;
        };
        if mark.as_char() == ';' {
            let message = "entries are separated by commas";
            return Err(Error::new(mark.span(), message));
        }
        let alone = mark.spacing() == Spacing::Alone && matches!(mark.as_char(), ':' | '=');
        let before = &tokens[index - 1];
        if alone && index > 1 && matches!(before, TokenTree::Ident(_)) {
            let message = format!("a comma is missing before `{before}`");
            return Err(Error::new(before.span(), message));
        }
    }
    Ok(())
}

fn add_entry(entries: &mut Vec<Entry>, entry: Entry) -> syn::Result<()> {
    if entries.iter().any(|known| known.key == entry.key) {
        let message = format!("`{}` is given twice", entry.key);
        return Err(Error::new(entry.key.span(), message));
    }
    entries.push(entry);
    Ok(())
}
