//! Required keys of a dataset file's tables.

use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::table::{Entry, Record};

pub(super) fn require_entry<'r, 'd>(
    record: &'r Record<'d>,
    key: &str,
    example: &str,
    found: &mut Diagnostics,
) -> Option<&'r Entry<'d>> {
    record.require(key, &format!("write {key} = {example}"), found)
}
