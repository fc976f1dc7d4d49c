//! Escapes control characters and bidirectional control characters in text for a terminal or a page.

use std::borrow::Cow;

/// Returns true for a control character other than line feed and tab, and for a bidirectional control character. If
/// they are printed unescaped, they can hide or forge text.
pub fn is_hidden(letter: char) -> bool {
    let is_directional = matches!(
        letter,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
    );
    is_directional || (letter.is_control() && !matches!(letter, '\n' | '\t'))
}

/// Writes hidden characters as `\u{202e}`.
pub fn escape_hidden(text: &str) -> Cow<'_, str> {
    escape_with(text, |letter| format!("\\u{{{:x}}}", u32::from(letter)))
}

/// Writes hidden characters as `\u202e`, an escape of strings in JSON and TOML.
pub fn escape_hidden_in_strings(text: &str) -> Cow<'_, str> {
    // All hidden characters have four hexadecimal digits.
    escape_with(text, |letter| format!("\\u{:04x}", u32::from(letter)))
}

fn escape_with(text: &str, escape: impl Fn(char) -> String) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        match is_hidden(letter) {
            true => shown += &escape(letter),
            false => shown.push(letter),
        }
    }
    Cow::Owned(shown)
}

#[cfg(test)]
mod tests {
    use super::{escape_hidden, escape_hidden_in_strings};

    #[test]
    fn only_hidden_characters_are_escaped() {
        let plain = "θ [°]\n\tשלום 转速";
        assert_eq!(escape_hidden(plain), plain);
        let hostile = "a\u{1b}[2J\u{202e}b\u{9b}\r";
        assert_eq!(escape_hidden(hostile), "a\\u{1b}[2J\\u{202e}b\\u{9b}\\u{d}");
        assert_eq!(
            escape_hidden_in_strings(hostile),
            "a\\u001b[2J\\u202eb\\u009b\\u000d"
        );
    }
}
