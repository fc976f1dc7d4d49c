//! Readers of texts, lists and new names in an effects file.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quote};
use eomgen_model_spec::quantity::StringValue;
use eomgen_model_spec::record::Record;
use eomgen_model_spec::table::Entry;

/// Reads the elements of a list; reports an empty list.
pub(super) fn read_nonempty_list<'d>(
    record: &Record<'d>,
    key: &str,
    example: &str,
    found: &mut Diagnostics,
) -> Option<Vec<Entry<'d>>> {
    let entry = record.require_with(key, &format!("write {key} = {example}"), found)?;
    let list = found.push_error(entry.list(example))?;
    if list.is_empty() {
        found.push(
            Diagnostic::error(format!("`{key}` is empty"))
                .with_span(entry.span(), "an effect needs one or more")
                .with_help(format!("write {key} = {example}")),
        );
    }
    Some(list)
}

/// Reads the text of a required key; reports an empty text.
pub(super) fn read_text(
    record: &Record<'_>,
    key: &str,
    example: &str,
    found: &mut Diagnostics,
) -> Option<StringValue> {
    let entry = record.require_with(key, &format!("write {key} = {example}"), found)?;
    let written = found.push_error(entry.written())?;
    if written.text.trim().is_empty() {
        found.push(
            Diagnostic::error(format!("`{key}` is empty")).with_span(written.span, "expected text"),
        );
    }
    Some(written)
}

/// Reads the name of an addition to a specification.
pub(super) fn read_new_name(record: &Record<'_>, found: &mut Diagnostics) -> Option<String> {
    let written = read_text(record, "name", "\"T_c\"", found)?;
    let letter = |c: char| c.is_ascii_alphabetic();
    let rest = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if !(written.text.starts_with(letter) && written.text.chars().all(rest)) {
        found.push(
            Diagnostic::error(format!("{} is not a name", quote(&written.text))).with_span(
                written.span,
                "expected a letter, then letters, digits and underscores",
            ),
        );
    }
    Some(written.text)
}
