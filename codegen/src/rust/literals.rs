//! Numbers and documentation as Rust source. All prose of a specification is converted to comments here;
//! names are checked when statements are built.

/// Writes a number with all its bits, in the shorter of the two usual notations.
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

/// Writes the documentation of an item, one comment for each line.
pub fn write_doc(lines: &[String]) -> String {
    write_comments("///", lines)
}

/// Writes the generator's documentation of an item, with links in brackets.
pub fn write_linked_doc(lines: &str) -> String {
    let line = |line: &str| match line {
        "" => "///\n".to_owned(),
        line => format!("/// {line}\n"),
    };
    lines.split('\n').map(line).collect()
}

/// Writes the documentation of the file.
pub fn write_file_doc(lines: &[String]) -> String {
    write_comments("//!", lines)
}

fn write_comments(opening: &str, lines: &[String]) -> String {
    lines
        .iter()
        .map(|line| format!("{opening}{}\n", escape_line(line)))
        .collect()
}

/// Prepares a line for a comment: adds a space in front, removes control characters and bidirectional control
/// characters (rejected by rustc), and escapes brackets that rustdoc would read as links or tags.
fn escape_line(text: &str) -> String {
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
