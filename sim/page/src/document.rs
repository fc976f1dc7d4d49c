//! The document around a page's body.

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// Of every page; `prefers-color-scheme` has the dark one.
const STYLE: &str = include_str!("style.css");

/// What a page with a script may do: run that script and no other, and load nothing.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; \
                      script-src 'unsafe-inline' 'wasm-unsafe-eval'";

/// A complete document. Control characters, of terminals say, have no place in HTML, not even
/// escaped, and are replaced.
pub fn document(title: &str, body: &Markup) -> String {
    around(title, &html! {}, body)
}

/// What a page with a script is made of.
#[derive(Clone, Copy, Debug)]
pub struct ScriptedDocument<'a> {
    /// Its title.
    pub title: &'a str,
    /// A style sheet besides that of every page. A part of the program, as the script is.
    pub style: &'a str,
    /// What it shows.
    pub body: &'a Markup,
    /// JSON that the script finds under the id `model`.
    pub data: &'a str,
    /// The script, which nothing from outside the program becomes a part of.
    pub script: &'a str,
}

/// A complete document with a script. It may compute with WebAssembly and may load nothing, from
/// the network or otherwise: browsers see to that.
pub fn scripted_document(parts: &ScriptedDocument<'_>) -> String {
    // In JSON this is a letter as any other, in HTML it might begin the end of the data.
    let data = parts.data.replace('<', "\\u003c");
    let head = html! {
        meta http-equiv="Content-Security-Policy" content=(POLICY);
        style { (PreEscaped(parts.style)) }
    };
    let body = html! {
        (parts.body)
        script #model type="application/json" { (PreEscaped(data)) }
        script { (PreEscaped(parts.script)) }
    };
    around(parts.title, &head, &body)
}

fn around(title: &str, head: &Markup, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
                (head)
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
    fn data_do_not_end_where_they_say_so() {
        let page = scripted_document(&ScriptedDocument {
            title: "a",
            style: "",
            body: &html! {},
            data: "[\"</script><!--<script>\"]",
            script: "",
        });
        assert_eq!(page.matches("<script").count(), 2, "{page}");
        assert!(
            page.contains("[\"\\u003c/script>\\u003c!--\\u003cscript>\"]"),
            "{page}"
        );
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
