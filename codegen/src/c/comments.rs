//! Documentation as C comments. Text from a specification cannot end a comment.

use super::names::item_name;
use crate::program::Program;

pub(super) fn comment(lines: &[String]) -> String {
    let lines: Vec<String> = lines.iter().map(|line| clean(line)).collect();
    match lines.as_slice() {
        [one] => format!("/** {one} */\n"),
        _ => {
            let inner = lines.iter().map(|line| match line.as_str() {
                "" => " *\n".to_owned(),
                line => format!(" * {line}\n"),
            });
            format!("/**\n{} */\n", inner.collect::<String>())
        }
    }
}

/// Splits documentation written by the generator into lines, and replaces links in brackets by C names.
pub(super) fn resolve_links(program: &Program, lines: &str) -> Vec<String> {
    let mut text = String::with_capacity(lines.len());
    let mut rest = lines;
    while let Some((before, after)) = rest.split_once("[`") {
        let Some((item, after)) = after.split_once("`]") else {
            break;
        };
        text.push_str(before);
        text.push_str(&format!("`{}`", item_name(program, item)));
        rest = after;
    }
    text.push_str(rest);
    let text = text.replace("`REGIME`", "`regime`");
    text.split('\n').map(str::to_owned).collect()
}

/// Removes comment delimiters, control characters, bidirectional control characters and trigraphs.
pub(super) fn clean(text: &str) -> String {
    let mut clean = String::with_capacity(text.len());
    for c in text.chars() {
        let last = clean.chars().next_back();
        match (last, c) {
            (Some('*'), '/') | (Some('/'), '*') | (Some('?'), '?') => clean.extend([' ', c]),
            (_, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}') => clean.push(' '),
            (_, c) if c.is_control() => clean.push(' '),
            (_, c) => clean.push(c),
        }
    }
    clean.trim_end().to_owned()
}
