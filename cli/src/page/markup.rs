//! Escaping, and the few HTML elements that several steps need.

use codegen::symbolic::formula::number_element;

/// Text that HTML takes for nothing but text, in content and in attributes.
pub(super) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        push_escaped(&mut safe, c);
    }
    safe
}

/// Appends a character, escaped. Control characters, of terminals say, are replaced.
pub(super) fn push_escaped(safe: &mut String, c: char) {
    match c {
        '&' => safe.push_str("&amp;"),
        '<' => safe.push_str("&lt;"),
        '>' => safe.push_str("&gt;"),
        '"' => safe.push_str("&quot;"),
        '\'' => safe.push_str("&#39;"),
        '\n' | '\t' => safe.push(c),
        c if c.is_control() => safe.push('\u{fffd}'),
        c => safe.push(c),
    }
}

/// A file's text behind a summary that opens it.
pub(super) fn folded(summary: &str, text: &str, open: bool) -> String {
    let open = if open { " open" } else { "" };
    format!(
        "<details{open}><summary>{}</summary>\n<pre><code>{}</code></pre></details>\n",
        escaped(summary),
        escaped(text)
    )
}

/// A number with so many digits after the first, powers of ten written out.
pub(super) fn number(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return escaped(&value.to_string());
    }
    let text = format!("{value:.digits$e}");
    // What has just been written as a number reads as one.
    let rounded: f64 = text.parse().unwrap_or(value);
    let magnitude = rounded.abs();
    let element = if magnitude == 0.0 || (1e-3..1e5).contains(&magnitude) {
        number_element(&rounded.to_string(), None)
    } else {
        let shortest = format!("{rounded:e}");
        let (mantissa, exponent) = shortest.split_once('e').unwrap_or((&shortest, "0"));
        number_element(mantissa, Some(exponent))
    };
    format!("<math>{element}</math>")
}

/// A table with its column headings.
pub(super) fn table(headings: &[&str], rows: &str) -> String {
    let headings: String = headings
        .iter()
        .map(|h| format!("<th scope=\"col\">{h}</th>"))
        .collect();
    format!(
        "<div class=\"wide\"><table>\n<thead><tr>{headings}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_becomes_text() {
        assert_eq!(
            escaped("<script a=\"b\">'&'</script>"),
            "&lt;script a=&quot;b&quot;&gt;&#39;&amp;&#39;&lt;/script&gt;"
        );
        assert_eq!(escaped("a\u{1b}[0m\0\n"), "a\u{fffd}[0m\u{fffd}\n");
    }

    #[test]
    fn numbers_are_written_for_people() {
        let element = |number: &str| format!("<math><mn>{number}</mn></math>");
        assert_eq!(number(0.0, 3), element("0"));
        assert_eq!(number(0.025, 5), element("0.025"));
        assert_eq!(number(-1234.56789, 5), element("−1234.57"));
        assert_eq!(
            number(1e-12, 2),
            "<math><msup><mn>10</mn><mn>−12</mn></msup></math>"
        );
        assert_eq!(
            number(2.5e8, 5),
            "<math><mn>2.5</mn><mo>·</mo><msup><mn>10</mn><mn>8</mn></msup></math>"
        );
        assert_eq!(number(f64::INFINITY, 2), "inf");
    }
}
