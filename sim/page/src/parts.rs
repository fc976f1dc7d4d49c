//! Parts of pages.

use maud::{Markup, PreEscaped, html};

use crate::prose::prose;

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

/// Returns a table whose rows are stacked in a narrow window: the first cell is above the others.
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

/// Figure with its caption.
#[derive(Clone, Copy, Debug)]
pub struct Figure<'a> {
    /// SVG of `eomgen_plot`, which escapes its texts. Only `svg` and `narrow` are inserted without escaping.
    pub svg: &'a str,
    /// The figure for narrow windows; empty if `svg` is used for all widths.
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
