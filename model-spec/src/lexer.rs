//! Splits the text of an expression into tokens.

use crate::diagnostic::{Diagnostic, quote};
use crate::foreign::{find_equivalent, find_operator};
use crate::greek::spell_greek;
use crate::span::Span;

/// Token of an expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Token {
    /// Kind of the token.
    pub kind: TokenKind,
    /// Position of the token.
    pub span: Span,
}

/// Kinds of tokens.
#[derive(Clone, Debug, PartialEq)]
pub enum TokenKind {
    /// A finite number, not negative.
    Number(f64),
    /// A name or a function's name.
    Name(String),
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `*`
    Star,
    /// `/`
    Slash,
    /// `^`
    Caret,
    /// `(`
    Open,
    /// `)`
    Close,
    /// `[`
    OpenIndex,
    /// `]`
    CloseIndex,
    /// `,`
    Comma,
    /// `.` without a digit after it
    Point,
}

impl TokenKind {
    /// Returns the token for a message, in backquotes.
    pub fn to_quoted(&self) -> String {
        match self {
            Self::Number(value) => format!("`{value}`"),
            Self::Name(name) => quote(name),
            Self::Plus => "`+`".to_owned(),
            Self::Minus => "`-`".to_owned(),
            Self::Star => "`*`".to_owned(),
            Self::Slash => "`/`".to_owned(),
            Self::Caret => "`^`".to_owned(),
            Self::Open => "`(`".to_owned(),
            Self::Close => "`)`".to_owned(),
            Self::OpenIndex => "`[`".to_owned(),
            Self::CloseIndex => "`]`".to_owned(),
            Self::Comma => "`,`".to_owned(),
            Self::Point => "`.`".to_owned(),
        }
    }
}

/// Splits an expression into tokens. `place` converts a byte range of `text` to a range of the source.
///
/// # Errors
/// A character or number is not part of the language; the error is at the first one.
pub fn tokenize(
    text: &str,
    place: impl Fn(usize, usize) -> Span,
) -> Result<Vec<Token>, Diagnostic> {
    let mut found = Vec::new();
    let mut start = 0;
    while let Some(first) = text[start..].chars().next() {
        let rest = &text[start..];
        if let Some(operator) = find_operator(rest) {
            return Err(foreign_operator_error(
                operator,
                place(start, start + operator.len()),
            ));
        }
        let length = match first {
            '.' if !starts_with_digit(&rest[1..]) => 1,
            ' ' | '\t' | '\n' | '\r' => {
                start += 1;
                continue;
            }
            '0'..='9' | '.' => number_length(rest),
            'a'..='z' | 'A'..='Z' | '_' => name_length(rest),
            _ => first.len_utf8(),
        };
        let span = place(start, start + length);
        let kind = read_token(&rest[..length], first, span)?;
        found.push(Token { kind, span });
        start += length;
    }
    Ok(found)
}

fn read_token(text: &str, first: char, span: Span) -> Result<TokenKind, Diagnostic> {
    Ok(match first {
        '.' if text == "." => TokenKind::Point,
        '0'..='9' | '.' => TokenKind::Number(read_number(text, span)?),
        'a'..='z' | 'A'..='Z' | '_' => TokenKind::Name(text.to_owned()),
        '+' => TokenKind::Plus,
        '-' => TokenKind::Minus,
        '*' => TokenKind::Star,
        '/' => TokenKind::Slash,
        '^' => TokenKind::Caret,
        '(' => TokenKind::Open,
        ')' => TokenKind::Close,
        '[' => TokenKind::OpenIndex,
        ']' => TokenKind::CloseIndex,
        ',' => TokenKind::Comma,
        other => return Err(stray_character_error(other, span)),
    })
}

fn foreign_operator_error(operator: &str, span: Span) -> Diagnostic {
    let help = find_equivalent(operator).map(str::to_owned);
    Diagnostic::error(format!("{} is not an operator", quote(operator)))
        .with_span(span, "not part of an expression")
        .with_optional_help(help)
}

fn stray_character_error(letter: char, span: Span) -> Diagnostic {
    let help = match letter {
        '\'' => "write dot(x) for the rate; an expression contains no strings".to_owned(),
        '"' => "an expression contains no strings".to_owned(),
        '{' | '}' => "group with ( and )".to_owned(),
        '·' | '×' => "write a product with `*`".to_owned(),
        '−' | '–' => "this character is not the minus sign `-` of the keyboard".to_owned(),
        _ if letter.is_alphabetic() => {
            let name = spell_greek(&letter.to_string());
            let name = name.map_or_else(String::new, |name| format!(": write {name}"));
            format!("names consist of the letters a-z and A-Z, digits and `_`{name}")
        }
        '°' => "write 20*pi/180 for 20 degrees".to_owned(),
        _ => "an expression consists of numbers, names and + - * / ^ ( ) , [ ]".to_owned(),
    };
    let shown = quote(letter.encode_utf8(&mut [0; 4]));
    Diagnostic::error(format!("{shown} is not part of an expression"))
        .with_span(span, "unexpected character")
        .with_help(help)
}

fn starts_with_digit(text: &str) -> bool {
    text.bytes()
        .next()
        .is_some_and(|byte| byte.is_ascii_digit())
}

fn name_length(text: &str) -> usize {
    let part = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    text.bytes().take_while(|&byte| part(byte)).count()
}

/// Returns the length of a number: digits, an optional point, and an exponent if the exponent has digits.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| {
        let rest = text.as_bytes().get(from..).unwrap_or_default();
        rest.iter().take_while(|byte| byte.is_ascii_digit()).count()
    };
    let at = |index: usize| text.as_bytes().get(index).copied();
    let mut length = digits(0);
    if at(length) == Some(b'.') {
        length += 1;
        length += digits(length);
    }
    if matches!(at(length), Some(b'e' | b'E')) {
        let signed = usize::from(matches!(at(length + 1), Some(b'+' | b'-')));
        let exponent = digits(length + 1 + signed);
        if exponent > 0 {
            length += 1 + signed + exponent;
        }
    }
    length
}

fn read_number(text: &str, span: Span) -> Result<f64, Diagnostic> {
    let value: f64 = text.parse().map_err(|_| {
        Diagnostic::error(format!("{} is not a number", quote(text)))
            .with_span(span, "here")
            .with_help("numbers are written 1, 0.5, .5 or 1e-3")
    })?;
    if value.is_infinite() {
        return Err(
            Diagnostic::error(format!("the number {} is too large", quote(text)))
                .with_span(span, "beyond 1.8e308"),
        );
    }
    check_underflow(text, value, span)?;
    Ok(value)
}

/// Rejects a decimal number other than 0 that would be rounded to 0.
pub(crate) fn check_underflow(text: &str, value: f64, span: Span) -> Result<(), Diagnostic> {
    let mantissa = text.split(['e', 'E']).next().unwrap_or_default();
    if value == 0.0 && mantissa.bytes().any(|byte| matches!(byte, b'1'..=b'9')) {
        return Err(
            Diagnostic::error(format!("the number {} is too small", quote(text)))
                .with_span(span, "below 4.9e-324, it would be read as 0"),
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<TokenKind> {
        let tokens = tokenize(text, Span::new).unwrap();
        tokens.into_iter().map(|token| token.kind).collect()
    }

    #[test]
    fn every_number_format_is_read() {
        for (text, value) in [
            ("1", 1.0),
            (".5", 0.5),
            ("2.", 2.0),
            ("1e-3", 1e-3),
            ("3.5E+2", 350.0),
        ] {
            assert_eq!(kinds(text), [TokenKind::Number(value)]);
        }
        let name = TokenKind::Name("e".to_owned());
        assert_eq!(kinds("1e"), [TokenKind::Number(1.0), name]);
    }

    #[test]
    fn numbers_out_of_range_are_rejected() {
        for text in ["1e999", "1e-999"] {
            assert!(tokenize(text, Span::new).is_err(), "{text}");
        }
        assert_eq!(kinds("0e-999"), [TokenKind::Number(0.0)]);
    }

    #[test]
    fn point_between_names_is_a_token() {
        let name = |text: &str| TokenKind::Name(text.to_owned());
        assert_eq!(kinds("r.x"), [name("r"), TokenKind::Point, name("x")]);
        assert_eq!(
            kinds("2.*.5"),
            [
                TokenKind::Number(2.0),
                TokenKind::Star,
                TokenKind::Number(0.5)
            ]
        );
    }

    #[test]
    fn token_spans_are_byte_ranges() {
        let spans: Vec<_> = tokenize("a_1 *\t(b", Span::new)
            .unwrap()
            .iter()
            .map(|token| (token.span.start, token.span.end))
            .collect();
        assert_eq!(spans, [(0, 3), (4, 5), (6, 7), (7, 8)]);
    }

    #[test]
    fn foreign_operators_are_rejected_with_help() {
        for (text, help) in [
            ("x'", "dot(x)"),
            ("x**2", "x^2"),
            ("x > a", "above(x - a)"),
            ("x <= a", "1 - above(x - a)"),
            ("x < a", "above(a - x)"),
            ("abs(x)>a", "contact(x, a)"),
            ("x == 0", "1 - contact"),
            ("x != 0", "contact("),
            ("above(x) && above(y)", "product"),
            ("a || b", "max("),
            ("|x|", "abs(x)"),
            ("x ? 1 : 0", "above(x - a)*A"),
            ("!a", "1 - above"),
            ("a % b", "atan2"),
            ("θ", "a-z"),
            ("a·b", "`*`"),
        ] {
            let diagnostic = tokenize(text, Span::new).expect_err(text);
            let given = diagnostic.help.unwrap_or_default();
            assert!(given.contains(help), "{text}: {given}");
        }
    }
}
