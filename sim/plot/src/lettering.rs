//! Text in a figure: upper bound of its width, truncation, and SVG with subscripts.

use eomgen_model_spec::hidden_characters::escape_hidden;
use maud::html;

use super::symbol::Symbol;

/// Width of a character relative to the font size, that of a digit in a wide sans serif font.
const CHARACTER_WIDTH: f64 = 0.62;
/// Font size of subscripts, relative to the text.
pub(super) const SUBSCRIPT_SIZE: f64 = 0.8;

pub(super) fn text_width(text: &str, size: f64) -> f64 {
    split_runs(text)
        .map(|run| {
            run.text.chars().count() as f64
                * if run.is_subscript {
                    SUBSCRIPT_SIZE
                } else {
                    1.0
                }
        })
        .sum::<f64>()
        * size
        * CHARACTER_WIDTH
}

pub(super) fn truncate_to_width(text: &str, size: f64, available: f64) -> String {
    let text = escape_hidden(text);
    let room = (available / (size * CHARACTER_WIDTH)).max(1.0);
    let excess: f64 = text.chars().map(|c| relative_width(c) - 1.0).sum();
    if text_width(&text, size) + excess * size * CHARACTER_WIDTH <= available {
        return text.into_owned();
    }
    let mut end = 1.0;
    let is_inside = |c: &char| {
        end += relative_width(*c);
        end <= room
    };
    let kept: String = text.chars().take_while(is_inside).collect();
    format!("{}…", kept.trim_end())
}

/// Splits text at spaces into lines of at most `available` px; a longer word is truncated.
pub(super) fn wrap_to_width(text: &str, size: f64, available: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match (longer, lines.last_mut()) {
            (Some(longer), Some(line)) if truncate_to_width(&longer, size, available) == longer => {
                *line = longer;
            }
            _ => lines.push(truncate_to_width(word, size, available)),
        }
    }
    lines
}

/// Splits the label of an axis into lines of at most `available` px: one line, or a line for the name and one
/// for the unit. A longer line is truncated.
pub(super) fn wrap_label(label: &str, size: f64, available: f64) -> Vec<String> {
    let whole = truncate_to_width(label, size, available);
    match label.rsplit_once(" [") {
        Some((name, unit)) if whole != label => [name, &format!("[{unit}")]
            .map(|line| truncate_to_width(line, size, available))
            .to_vec(),
        _ => vec![whole],
    }
}

/// Returns the maximum width of a character, relative to [`CHARACTER_WIDTH`].
fn relative_width(c: char) -> f64 {
    match c {
        'm' | 'w' | 'M' | 'W' | '@' | '%' | '\u{2e80}'.. => 1.6,
        c if c.is_uppercase() => 1.25,
        _ => 1.0,
    }
}

pub(super) fn svg_spans(text: &str, size: f64) -> String {
    let mut svg = String::new();
    let mut lowered = false;
    for run in split_runs(text) {
        let shift = match (lowered, run.is_subscript) {
            (false, true) => 0.22 * size,
            (true, false) => -0.22 * size,
            _ => 0.0,
        };
        lowered = run.is_subscript;
        let smaller = if run.is_subscript {
            SUBSCRIPT_SIZE * size
        } else {
            size
        };
        if shift == 0.0 {
            svg.push_str(&escape_xml(&run.text));
        } else {
            svg.push_str(&format!(
                "<tspan dy=\"{shift:.1}\" font-size=\"{smaller:.1}\">{}</tspan>",
                escape_xml(&run.text)
            ));
        }
    }
    svg
}

/// Returns text as XML character data on one line, with visible escapes of hidden characters.
pub(super) fn escape_xml(text: &str) -> String {
    let shown: String = escape_hidden(text)
        .chars()
        .map(|c| match c {
            '\n' | '\t' => ' ',
            // XML forbids these characters, even escaped.
            '\u{fffe}' | '\u{ffff}' => '\u{fffd}',
            c => c,
        })
        .collect();
    html! { (shown) }.into_string()
}

pub(super) struct Run {
    pub text: String,
    pub is_subscript: bool,
}

/// Splits text into words and separators. Names are split into letter and subscript.
pub(super) fn split_runs(text: &str) -> impl Iterator<Item = Run> {
    let in_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut rest = text;
    let mut pieces = Vec::new();
    while let Some(first) = rest.chars().next() {
        let word = in_word(first);
        let end = rest.find(|c| in_word(c) != word).unwrap_or(rest.len());
        let (piece, after) = rest.split_at(end);
        rest = after;
        let symbol = if word {
            Symbol::parse(piece)
        } else {
            Symbol {
                head: piece.to_owned(),
                subscript: String::new(),
            }
        };
        pieces.push((symbol.head, false));
        pieces.push((symbol.subscript, true));
    }
    pieces
        .into_iter()
        .filter(|(text, _)| !text.is_empty())
        .map(|(text, lowered)| Run {
            text,
            is_subscript: lowered,
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subscripts_become_spans_and_base_line_returns() {
        assert_eq!(
            svg_spans("x_sp [µm]", 10.0),
            "x<tspan dy=\"2.2\" font-size=\"8.0\">sp</tspan>\
             <tspan dy=\"-2.2\" font-size=\"10.0\"> [</tspan>µm]"
        );
        assert_eq!(svg_spans("a < b & c", 10.0), "a &lt; b &amp; c");
    }

    #[test]
    fn long_text_is_wrapped_at_spaces() {
        let text = "Relative displacement of sun and planet along the line of action";
        let lines = wrap_to_width(text, 16.0, 300.0);
        assert!(lines.len() > 1 && lines.join(" ") == text, "{lines:?}");
        assert!(lines.iter().all(|line| text_width(line, 16.0) <= 300.0));
        assert!(wrap_to_width("", 16.0, 300.0).is_empty());
        let word = "x".repeat(100);
        assert!(wrap_to_width(&word, 16.0, 300.0)[0].ends_with('…'));
    }

    #[test]
    fn unit_of_a_long_label_is_on_a_line_of_its_own() {
        let label = "flow [10⁻⁶ m³/s]";
        assert_eq!(wrap_label(label, 15.0, 300.0), [label]);
        assert_eq!(wrap_label(label, 15.0, 140.0), ["flow", "[10⁻⁶ m³/s]"]);
        assert!(wrap_label(&"x".repeat(40), 15.0, 140.0)[0].ends_with('…'));
    }

    #[test]
    fn long_text_is_truncated() {
        let long = "word ".repeat(1000);
        let cut = truncate_to_width(&long, 14.0, 200.0);
        assert!(cut.ends_with('…') && text_width(&cut, 14.0) <= 200.0);
        assert_eq!(truncate_to_width("short", 14.0, 200.0), "short");
    }

    #[test]
    fn hidden_characters_are_escaped_and_forbidden_ones_replaced() {
        assert_eq!(
            escape_xml("a\0b\u{1b}c\nd\u{ffff}"),
            "a\\u{0}b\\u{1b}c d\u{fffd}"
        );
        assert_eq!(svg_spans("x\u{202e}y", 10.0), "x\\u{202e}y");
    }
}
