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
    html! {
        div.wide {
            table {
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

/// Figure with its caption.
#[derive(Clone, Copy, Debug)]
pub struct Figure<'a> {
    /// SVG of `eomgen_plot`, which escapes its texts. It is the only text that becomes markup.
    pub svg: &'a str,
    /// Caption; empty for none.
    pub caption: &'a str,
}

/// Returns a figure as an HTML element.
pub fn figure(figure: Figure<'_>) -> Markup {
    html! {
        figure {
            (PreEscaped(figure.svg))
            @if !figure.caption.is_empty() { figcaption { (figure.caption) } }
        }
    }
}
