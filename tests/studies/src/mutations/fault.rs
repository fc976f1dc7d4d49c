//! Faults (mutations): small changes of a source that still compiles in most cases.

use std::fmt;
use std::ops::Range;

use eomgen_validate::random::Random;

use super::tokens::{Kind as Token, tokens};

/// Kind of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A digit of a number is changed.
    Number,
    /// An operator is replaced.
    Operator,
    /// A name is replaced by another name of the same function.
    Name,
    /// A letter of a string is changed.
    Text,
    /// A statement is removed.
    Statement,
}

impl Kind {
    pub fn name(self) -> &'static str {
        match self {
            Self::Number => "number",
            Self::Operator => "operator",
            Self::Name => "name",
            Self::Text => "text",
            Self::Statement => "statement",
        }
    }
}

/// Change of a source.
pub struct Fault {
    pub kind: Kind,
    pub range: Range<usize>,
    pub before: String,
    pub after: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: `{}` -> `{}`",
            self.kind.name(),
            self.before,
            self.after
        )
    }
}

/// Number of draws after which a source counts as a source without possible faults.
const MAX_DRAWS: usize = 10_000;

/// Maximum distance in tokens between a name and its replacement.
const NEAR: usize = 400;

/// Draws a random fault in a source; `None` if none is possible.
pub fn draw(source: &str, random: &mut Random) -> Option<Fault> {
    let tokens = tokens(source);
    let text = |index: usize| {
        tokens
            .get(index)
            .map_or("", |(_, range)| &source[range.clone()])
    };
    let kinds = [
        Kind::Number,
        Kind::Operator,
        Kind::Name,
        Kind::Text,
        Kind::Statement,
    ];
    for _ in 0..MAX_DRAWS {
        let kind = *random.pick(&kinds)?;
        let place = (random.unit() * tokens.len() as f64) as usize;
        let (token, range) = tokens.get(place)?;
        // Preprocessor lines and the identity symbol are not part of the functions, so they receive no faults.
        let line_start = source[..range.start].rfind('\n').map_or(0, |end| end + 1);
        let line = source[line_start..].lines().next().unwrap_or("");
        let is_directive =
            line.starts_with('#') && !line.starts_with("#define") || line.starts_with('/');
        if is_directive || line.contains("eomgen") || line.contains("GENERATOR_VERSION") {
            continue;
        }
        let change = match (kind, token) {
            (Kind::Number, Token::Number) => other_number(text(place), random),
            (Kind::Operator, Token::Sign) => {
                let is_binary =
                    source[..range.start].ends_with(' ') && source[range.end..].starts_with(' ');
                other_operator(text(place))
                    .filter(|_| is_binary)
                    .map(str::to_owned)
            }
            (Kind::Name, Token::Word) => {
                let near = place.saturating_sub(NEAR)..(place + NEAR).min(tokens.len());
                let names: Vec<&str> = near
                    .filter(|index| tokens[*index].0 == Token::Word)
                    .map(text)
                    .filter(|name| *name != text(place) && class(name) == class(text(place)))
                    .collect();
                random.pick(&names).map(|name| (*name).to_owned())
            }
            (Kind::Text, Token::Text) if range.len() > 2 => {
                let inner = &source[range.start + 1..range.end - 1];
                Some(format!("\"{inner}_\""))
            }
            (Kind::Statement, Token::Sign) if text(place) == ";" => {
                let start = source[..range.start]
                    .rfind([';', '{', '}'])
                    .map_or(0, |end| end + 1);
                let statement = source[start..range.end].trim();
                let is_assignment = statement.contains('=')
                    && !statement.contains("//")
                    && !statement.contains("/*");
                if is_assignment {
                    let begin = range.end - statement.len();
                    return Some(Fault {
                        kind,
                        before: statement.to_owned(),
                        range: begin..range.end,
                        after: String::new(),
                    });
                }
                None
            }
            _ => None,
        };
        if let Some(after) = change {
            return Some(Fault {
                kind,
                before: text(place).to_owned(),
                range: range.clone(),
                after,
            });
        }
    }
    None
}

/// Changes one digit of a number.
fn other_number(number: &str, random: &mut Random) -> Option<String> {
    let digits: Vec<usize> = number
        .char_indices()
        .filter(|(_, c)| c.is_ascii_digit())
        .map(|(place, _)| place)
        .collect();
    let place = *random.pick(&digits)?;
    let digit = number.as_bytes()[place] - b'0';
    let other = (digit + 1 + (random.unit() * 9.0) as u8) % 10;
    Some(format!(
        "{}{other}{}",
        &number[..place],
        &number[place + 1..]
    ))
}

fn other_operator(operator: &str) -> Option<&'static str> {
    Some(match operator {
        "+" => "-",
        "-" => "+",
        "*" => "/",
        "/" => "*",
        "<" => ">",
        ">" => "<",
        _ => return None,
    })
}

/// Returns the letters of a name before its number. A name is replaced only by a name of the same class.
fn class(name: &str) -> (&str, bool) {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let is_constant = name.bytes().all(|b| !b.is_ascii_lowercase());
    match stem.len() < name.len() {
        true => (stem, is_constant),
        false => ("", is_constant),
    }
}
