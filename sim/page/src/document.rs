//! The document around a page's body.

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// Of every page; `prefers-color-scheme` has the dark one.
const STYLE: &str = include_str!("style.css");

/// A complete document. Control characters, of terminals say, have no place in HTML, not even
/// escaped, and are replaced.
pub fn document(title: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body { (body) }
        }
        "\n"
    };
    page.into_string()
        .chars()
        .map(|c| match c {
            '\n' | '\t' => c,
            c if c.is_control() => '\u{fffd}',
            c => c,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_becomes_text_wherever_it_stands() {
        let hostile = "</title><script a=\"b\">'&'</script>";
        let body = html! { p title=(hostile) { (hostile) } };
        let page = document(hostile, &body);
        assert!(!page.contains("<script"), "{page}");
        let text = "&lt;/title&gt;&lt;script a=&quot;b&quot;&gt;'&amp;'&lt;/script&gt;";
        assert!(page.contains(&format!("<title>{text}</title>")), "{page}");
        assert!(page.contains(&format!("<p title=\"{text}\">{text}</p>")));
    }

    #[test]
    fn what_html_forbids_is_replaced() {
        let page = document("a\u{1b}[0m\0\n", &html! {});
        assert!(page.contains("<title>a\u{fffd}[0m\u{fffd}\n</title>"));
    }

    #[test]
    fn the_style_refers_to_nothing_outside() {
        for forbidden in ["http", "//", "url(", "@import", "</"] {
            assert!(!STYLE.contains(forbidden), "{forbidden}");
        }
    }
}
