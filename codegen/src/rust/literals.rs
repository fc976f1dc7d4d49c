//! Numbers, names and documentation as source. Text from a specification passes through
//! here and nowhere else: names are checked to be identifiers where statements are made, prose becomes comments.

/// A number with all its bits, in the shorter of the two usual notations.
pub fn number(value: f64) -> String {
    if value.is_nan() {
        return "f64::NAN".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 {
            "f64::INFINITY".to_owned()
        } else {
            "f64::NEG_INFINITY".to_owned()
        };
    }
    let magnitude = value.abs();
    let plain = magnitude == 0.0 || (1e-4..1e7).contains(&magnitude);
    if plain {
        format!("{value:?}")
    } else {
        format!("{value:e}")
    }
}

/// Documentation of the item that follows, a comment per line.
pub fn doc(lines: &[String]) -> String {
    comments("///", lines)
}

/// Documentation of the item that follows: the generator's own lines, with links in brackets.
pub fn linked_doc(lines: &str) -> String {
    let line = |line: &str| match line {
        "" => "///\n".to_owned(),
        line => format!("/// {line}\n"),
    };
    lines.split('\n').map(line).collect()
}

/// Documentation of the file.
pub fn file_doc(lines: &[String]) -> String {
    comments("//!", lines)
}

fn comments(opening: &str, lines: &[String]) -> String {
    lines
        .iter()
        .map(|line| format!("{opening}{}\n", single_line(line)))
        .collect()
}

/// Without control characters and without those that turn the direction of the text, which
/// rustc refuses, with a space in front as in a written comment, and with
/// brackets that rustdoc would take for links or tags defused.
fn single_line(text: &str) -> String {
    let mut clean = String::with_capacity(text.len() + 1);
    for c in text.chars() {
        match c {
            '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => clean.push(' '),
            c if c.is_control() => clean.push(' '),
            '[' | '<' => clean.extend(['\\', c]),
            c => clean.push(c),
        }
    }
    let clean = clean.trim_end_matches(' ');
    if clean.is_empty() {
        String::new()
    } else {
        format!(" {clean}")
    }
}
