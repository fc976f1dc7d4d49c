//! The document around a page's body.

use eomgen_model_spec::visible::{is_hidden, visible};
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// Of every page; `prefers-color-scheme` has the dark one.
const STYLE: &str = include_str!("style.css");

/// Content security policy of a page without a script: its own styles, and nothing from elsewhere.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:";

/// Content security policy of a page with a script: that script besides.
const SCRIPT_POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; \
                             script-src 'unsafe-inline' 'wasm-unsafe-eval'";

/// A complete document that loads nothing and runs no script: its content security policy forbids both.
/// Control characters and those that reverse the direction of writing are shown as `\u{202e}`.
pub fn document(title: &str, body: &Markup) -> String {
    around(title, POLICY, &html! {}, body)
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
    let data = data_text(parts.data);
    let head = html! { style { (PreEscaped(parts.style)) } };
    let body = html! {
        (parts.body)
        script #model type="application/json" { (PreEscaped(data)) }
        script { (PreEscaped(parts.script)) }
    };
    around(parts.title, SCRIPT_POLICY, &head, &body)
}

/// JSON that ends no element of HTML, and whose strings hold the escapes of hidden characters instead of
/// these.
fn data_text(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for letter in json.chars() {
        match letter {
            '<' => text += "\\u003c",
            letter if is_hidden(letter) => {
                text.push('\\');
                text += &visible(letter.encode_utf8(&mut [0; 4]));
            }
            letter => text.push(letter),
        }
    }
    text
}

fn around(title: &str, policy: &str, head: &Markup, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
                (head)
            }
            body { (body) }
        }
        "\n"
    };
    visible(&page.into_string()).into_owned()
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
    fn hidden_characters_are_escaped_in_text_and_data() {
        let page = document("a\u{1b}[0m\0\u{202e}\n", &html! {});
        assert!(
            page.contains("<title>a\\u{1b}[0m\\u{0}\\u{202e}\n</title>"),
            "{page}"
        );
        let page = scripted_document(&ScriptedDocument {
            title: "a",
            style: "",
            body: &html! {},
            data: "[\"a\u{202e}b \\\\u{7}\"]",
            script: "",
        });
        // JSON for the text a\u{202e}b \u{7}.
        assert!(page.contains(r#"["a\\u{202e}b \\u{7}"]"#), "{page}");
    }

    #[test]
    fn every_page_forbids_what_is_not_its_own() {
        let page = document("a", &html! {});
        let policy = "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; ";
        assert_eq!(page.matches(policy).count(), 1, "{page}");
        assert!(!page.contains("script-src"), "{page}");
    }

    #[test]
    fn the_style_refers_to_nothing_outside() {
        for forbidden in ["http", "//", "url(", "@import", "</"] {
            assert!(!STYLE.contains(forbidden), "{forbidden}");
        }
    }
}
