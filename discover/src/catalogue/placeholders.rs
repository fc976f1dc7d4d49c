//! Placeholders in the texts of an effect. All placeholders must be known, and the expressions that
//! contain them must be valid.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quote};
use eomgen_model_spec::quantity::StringValue;
use eomgen_model_spec::record::Record;
use eomgen_model_spec::suggest::did_you_mean;

use super::fields::read_text;

/// Placeholders that the texts of an effect may contain.
pub(super) struct Placeholders {
    /// Names of the defined placeholders.
    pub(super) known: Vec<String>,
    /// Names of the used placeholders.
    pub(super) used: Vec<String>,
}

impl Placeholders {
    /// Reports undefined placeholders of a text.
    pub(super) fn check_placeholders(&mut self, written: &StringValue, found: &mut Diagnostics) {
        let mut begin = 0;
        while let Some(open) = written.text[begin..].find(['{', '}']) {
            let open = begin + open;
            let close = written.text[open..].find('}').map(|length| open + length);
            let Some(close) = close.filter(|close| *close > open) else {
                let place = written.place(open, open + 1);
                let wrong = Diagnostic::error("the braces of a placeholder are not balanced");
                found.push(wrong.with_span(place, "expected a name in braces, as {on}"));
                return;
            };
            let name = &written.text[open + 1..close];
            if self.known.iter().any(|known| known == name) {
                self.used.push(name.to_owned());
            } else {
                let known = || self.known.iter().map(String::as_str);
                let listed: Vec<&str> = known().collect();
                let listed = format!("known placeholders: {}", listed.join(", "));
                found.push(
                    Diagnostic::error(format!("unknown placeholder {}", quote(name)))
                        .with_span(written.place(open + 1, close), "not defined here")
                        .with_help(did_you_mean(name, known()).unwrap_or(listed)),
                );
            }
            begin = close + 1;
        }
    }
}

/// Reads an expression with placeholders.
pub(super) fn read_expression(
    record: &Record<'_>,
    key: &str,
    placeholders: &mut Placeholders,
    found: &mut Diagnostics,
) -> Option<String> {
    let written = read_text(record, key, "\"-{T_c}*sign(dot({on}))\"", found)?;
    placeholders.check_placeholders(&written, found);
    // Braces are replaced by parentheses, so that errors have the correct column.
    let mut plain = written.clone();
    plain.text = plain.text.replace('{', "(").replace('}', ")");
    found.push_error(plain.syntax());
    Some(written.text)
}
