//! Parts of pages.

use maud::{Markup, PreEscaped, html};

/// Returns a section with a heading.
pub fn section(heading: &str, content: &Markup) -> Markup {
    html! {
        section {
            h2 { (heading) }
            (content)
        }
    }
}

/// Returns a table; `rows` are its `tr` elements.
pub fn table(headings: &[&str], rows: &Markup) -> Markup {
    table_of_class(None, headings, rows)
}

/// Returns a table. In a narrow window, the first cell of a row is above the others.
pub fn stacked_table(headings: &[&str], rows: &Markup) -> Markup {
    table_of_class(Some("stacked"), headings, rows)
}

fn table_of_class(class: Option<&str>, headings: &[&str], rows: &Markup) -> Markup {
    html! {
        div.wide {
            table class=[class] {
                thead { tr { @for heading in headings { th scope="col" { (heading) } } } }
                tbody { (rows) }
            }
        }
    }
}

/// Returns a file's text as a collapsible element with a summary.
pub fn collapsible_file(summary: &str, text: &str, is_open: bool) -> Markup {
    html! {
        details open[is_open] {
            summary { (summary) }
            pre { code { (text) } }
        }
    }
}

/// Returns prose, with the parts between backticks and names with underscores as code. No line breaks before a percent
/// sign.
pub fn prose(text: &str) -> Markup {
    html! {
        @for (place, part) in text.split('`').enumerate() {
            @if place % 2 == 1 { code { (part) } } @else { (named_words(&part.replace(" %", "\u{a0}%"))) }
        }
    }
}

/// Returns text, with names that contain an underscore as code.
fn named_words(text: &str) -> Markup {
    let is_letter = |c: char| c.is_alphanumeric() || c == '_';
    let mut pieces: Vec<&str> = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_word = is_letter(first);
        let end = rest.find(|c| is_letter(c) != is_word);
        let (piece, after) = rest.split_at(end.unwrap_or(rest.len()));
        pieces.push(piece);
        rest = after;
    }
    html! { @for piece in pieces { @if piece.contains('_') { code { (piece) } } @else { (piece) } } }
}

/// Figure with its caption.
#[derive(Clone, Copy, Debug)]
pub struct Figure<'a> {
    /// SVG of `eomgen_plot`, which escapes its texts. It is the only text that becomes markup, with
    /// `narrow`.
    pub svg: &'a str,
    /// The same figure for narrow windows; empty if `svg` is for all.
    pub narrow: &'a str,
    /// Caption; empty for none.
    pub caption: &'a str,
}

/// Returns a figure as an HTML element.
pub fn figure(figure: Figure<'_>) -> Markup {
    let Figure {
        svg,
        narrow,
        caption,
    } = figure;
    html! {
        figure {
            @if narrow.is_empty() {
                (PreEscaped(svg))
            } @else {
                div.wide-figure { (PreEscaped(svg)) }
                div.narrow-figure { (PreEscaped(narrow)) }
            }
            @if !caption.is_empty() { figcaption { (prose(caption)) } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::prose;

    #[test]
    fn names_and_backticks_become_code() {
        let set = |text: &str| prose(text).into_string();
        assert_eq!(set("run `a < b` now"), "run <code>a &lt; b</code> now");
        assert_eq!(set("plain"), "plain");
        assert_eq!(
            set("by 8.2 %, `a % b`"),
            "by 8.2\u{a0}%, <code>a % b</code>"
        );
        assert_eq!(
            set("Found: T_c = 3 N, b."),
            "Found: <code>T_c</code> = 3 N, b."
        );
    }
}
