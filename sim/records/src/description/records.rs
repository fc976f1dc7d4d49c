//! Table `[records]`: files, or parts of files, for training and testing.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::quantity::{Number, StringValue};
use eomgen_model_spec::record::Record;
use eomgen_model_spec::span::Span;
use eomgen_model_spec::table::Entry;

use super::keys;

/// Table `[records]`.
#[derive(Debug)]
pub struct Records {
    /// Training files, relative to the dataset's folder.
    pub train: Vec<Stretch>,
    /// Test files, relative to the dataset's folder.
    pub test: Vec<Stretch>,
    /// Location of the table.
    pub span: Span,
}

/// File, or the part of it between two times.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// Path of the file.
    pub file: StringValue,
    /// First time, in the unit of the time column.
    pub from: Option<Number>,
    /// End time, exclusive.
    pub to: Option<Number>,
}

pub(super) fn read_records(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<Records> {
    let record = Record::read(entry, &keys::RECORDS, found)?;
    let mut files = |key: &str| {
        let Some(entry) = record.get(key) else {
            return Vec::new();
        };
        let elements = found
            .push_error(entry.list("[\"record.csv\"]"))
            .unwrap_or_default();
        let stretches = elements.iter();
        stretches
            .filter_map(|element| read_stretch(element, found))
            .collect()
    };
    Some(Records {
        train: files("train"),
        test: files("test"),
        span: entry.name.span,
    })
}

fn read_stretch(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<Stretch> {
    if !entry.is_table() {
        let file = found.push_error(entry.written())?;
        return Some(Stretch {
            file,
            from: None,
            to: None,
        });
    }
    let record = Record::read(entry, &keys::STRETCH, found)?;
    let file = record.required("file", Entry::written, found);
    let [from, to] = ["from", "to"].map(|key| record.number(key, found));
    if let (Some(from), Some(to)) = (from, to)
        && from.value >= to.value
    {
        found.push(
            Diagnostic::error(format!(
                "the part from {} to {} is empty",
                from.value, to.value
            ))
            .with_span(to.span, "expected a later time")
            .with_related_span(from.span, "than this"),
        );
    }
    Some(Stretch {
        file: file?,
        from,
        to,
    })
}
