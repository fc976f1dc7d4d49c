//! Keys that a table of a dataset file cannot do without.

use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::table::{Entry, Record};

/// The entry of a key that cannot be left out.
pub(super) fn required<'r, 'd>(
    record: &'r Record<'d>,
    key: &str,
    example: &str,
    found: &mut Diagnostics,
) -> Option<&'r Entry<'d>> {
    record.require(key, &format!("write {key} = {example}"), found)
}
