//! What pages are made of.

use maud::{Markup, PreEscaped, html};

/// A section under a heading.
pub fn section(heading: &str, content: &Markup) -> Markup {
    html! {
        section {
            h2 { (heading) }
            (content)
        }
    }
}

/// A table: its column headings, and its rows as `tr` elements.
pub fn table(headings: &[&str], rows: &Markup) -> Markup {
    html! {
        div.wide {
            table {
                thead { tr { @for heading in headings { th scope="col" { (heading) } } } }
                tbody { (rows) }
            }
        }
    }
}

/// A file's text behind a summary that opens it.
pub fn folded(summary: &str, text: &str, is_open: bool) -> Markup {
    html! {
        details open[is_open] {
            summary { (summary) }
            pre { code { (text) } }
        }
    }
}

/// A figure with its caption.
#[derive(Clone, Copy, Debug)]
pub struct Figure<'a> {
    /// SVG as `eomgen_plot` draws it, which escapes its texts: the one text that a page takes
    /// for markup.
    pub svg: &'a str,
    /// What to look for; empty for a figure without a caption.
    pub caption: &'a str,
}

/// A figure in a page.
pub fn figure(figure: Figure<'_>) -> Markup {
    html! {
        figure {
            (PreEscaped(figure.svg))
            @if !figure.caption.is_empty() { figcaption { (figure.caption) } }
        }
    }
}
