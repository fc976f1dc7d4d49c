//! Tokens of emitted C and Rust, without comments.

use std::ops::Range;

/// Kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Identifier or keyword.
    Word,
    /// Number.
    Number,
    /// String without escapes.
    Text,
    /// Any other character.
    Sign,
}

/// Returns the tokens with their byte ranges.
pub fn tokens(source: &str) -> Vec<(Kind, Range<usize>)> {
    let bytes = source.as_bytes();
    let mut found = Vec::new();
    let mut at = 0;
    let is_word = |b: u8| b.is_ascii_alphanumeric() || b == b'_';
    while at < bytes.len() {
        let rest = &source[at..];
        let start = at;
        if rest.starts_with("/*") {
            at += rest.find("*/").map_or(rest.len(), |end| end + 2);
        } else if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
        } else if bytes[at].is_ascii_whitespace() {
            at += 1;
        } else if bytes[at] == b'"' {
            let end = rest[1..].find('"').map_or(rest.len(), |end| end + 2);
            at += end;
            found.push((Kind::Text, start..at));
        } else if bytes[at].is_ascii_digit() {
            while at < bytes.len()
                && (is_word(bytes[at])
                    || bytes[at] == b'.' && bytes.get(at + 1).is_some_and(u8::is_ascii_digit)
                    || matches!(bytes[at], b'-' | b'+') && matches!(bytes[at - 1], b'e' | b'E'))
            {
                at += 1;
            }
            found.push((Kind::Number, start..at));
        } else if is_word(bytes[at]) {
            while at < bytes.len() && is_word(bytes[at]) {
                at += 1;
            }
            found.push((Kind::Word, start..at));
        } else {
            at += rest.chars().next().map_or(1, char::len_utf8);
            found.push((Kind::Sign, start..at));
        }
    }
    found
}

/// Returns the text of all tokens, separated by spaces.
pub fn without_comments(source: &str) -> String {
    let words = tokens(source).into_iter().map(|(_, range)| &source[range]);
    words.collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_spaces_are_not_tokens() {
        let source = "/* 1 */ x = -1.5e-3*s_2; // y\nz(\"a b\")";
        let expected = "x = - 1.5e-3 * s_2 ; z ( \"a b\" )";
        assert_eq!(without_comments(source), expected);
    }
}
