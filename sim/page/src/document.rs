//! HTML document around a page's body.

use eomgen_model_spec::hidden_characters::{escape_hidden, is_hidden};
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// Style of every page, with a dark scheme by `prefers-color-scheme`.
const STYLE: &str = include_str!("style.css");

/// Content security policy of a page without a script: only inline styles, nothing external.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:";

/// Content security policy of a page with a script: inline styles and scripts, nothing external.
const SCRIPT_POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; \
                             script-src 'unsafe-inline' 'wasm-unsafe-eval'";

/// Style without JavaScript: hides elements whose content is computed by a script, and gives the controls
/// their natural height.
const UNSCRIPTED_STYLE: &str = ".scripted { display: none; } .controls { contain: none; }";

/// Returns a complete document without scripts and external resources; its content security policy
/// forbids both. Control characters and characters that reverse the writing direction appear as
/// escapes such as `\u{202e}`.
pub fn document(title: &str, body: &Markup) -> String {
    wrap_body(title, POLICY, &html! {}, body)
}

/// Parts of a page with a script.
#[derive(Clone, Copy, Debug)]
pub struct ScriptedDocument<'a> {
    /// Title of the page.
    pub title: &'a str,
    /// Additional style sheet: a constant of the program.
    pub style: &'a str,
    /// Body of the page.
    pub body: &'a Markup,
    /// JSON text of the element with the id `model`.
    pub data: &'a str,
    /// Script: a constant of the program, without external input.
    pub script: &'a str,
}

/// Returns a document with a script. Without JavaScript, elements of the class `scripted` are hidden. Its content security policy forbids all loading.
pub fn scripted_document(parts: &ScriptedDocument<'_>) -> String {
    let data = data_text(parts.data);
    let head = html! {
        style { (PreEscaped(parts.style)) }
        noscript { style { (PreEscaped(UNSCRIPTED_STYLE)) } }
    };
    let body = html! {
        (parts.body)
        script #model type="application/json" { (PreEscaped(data)) }
        script { (PreEscaped(parts.script)) }
    };
    wrap_body(parts.title, SCRIPT_POLICY, &head, &body)
}

/// Escapes hidden characters of JSON and `<`, so that it cannot end an HTML element.
fn data_text(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for letter in json.chars() {
        match letter {
            '<' => text += "\\u003c",
            letter if is_hidden(letter) => {
                text.push('\\');
                text += &escape_hidden(letter.encode_utf8(&mut [0; 4]));
            }
            letter => text.push(letter),
        }
    }
    text
}

fn wrap_body(title: &str, policy: &str, head: &Markup, body: &Markup) -> String {
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
    escape_hidden(&page.into_string()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_is_escaped_everywhere() {
        let hostile = "</title><script a=\"b\">'&'</script>";
        let body = html! { p title=(hostile) { (hostile) } };
        let page = document(hostile, &body);
        assert!(!page.contains("<script"), "{page}");
        let text = "&lt;/title&gt;&lt;script a=&quot;b&quot;&gt;'&amp;'&lt;/script&gt;";
        assert!(page.contains(&format!("<title>{text}</title>")), "{page}");
        assert!(page.contains(&format!("<p title=\"{text}\">{text}</p>")));
    }

    #[test]
    fn data_cannot_end_their_element() {
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
    fn every_page_forbids_external_resources() {
        let page = document("a", &html! {});
        let policy = "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; ";
        assert_eq!(page.matches(policy).count(), 1, "{page}");
        assert!(!page.contains("script-src"), "{page}");
    }

    #[test]
    fn style_has_no_external_references() {
        for forbidden in ["http", "//", "url(", "@import", "</"] {
            assert!(!STYLE.contains(forbidden), "{forbidden}");
        }
    }
}
