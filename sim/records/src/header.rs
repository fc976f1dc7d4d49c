//! Column names and the maximum number of samples, for all file formats.

use std::path::Path;

use eomgen_model_spec::hidden_characters::escape_hidden;
use eomgen_model_spec::suggest::nearest;

use crate::decimal::Decimal;
use crate::description::columns::ColumnKey;
use crate::refusal::Refusal;

/// Maximum number of samples of a record. It is a hundred times the number that a search processes in minutes.
pub const MAX_SAMPLES: usize = 1_000_000;

#[derive(Clone, Debug, Default)]
pub struct Table {
    pub columns: Vec<Vec<f64>>,
    /// Line number of each row, from 1; in files without lines the first row has number 2.
    pub lines: Vec<u64>,
    /// Numbers of the first column without rounding; `None` for a missing number.
    pub decimals: Vec<Option<Decimal>>,
}

pub(crate) const COMMENT: char = '#';

/// Returns the indices of the wanted columns. `line` is the line number of the names.
pub fn find_columns(
    path: &Path,
    line: u64,
    there: &[String],
    wanted: &[&ColumnKey],
) -> Result<Vec<usize>, Refusal> {
    let place = |key: &&ColumnKey| {
        let name = match key {
            ColumnKey::Name(name) => &name.text,
            ColumnKey::Number(number, _) if *number <= there.len() => return Ok(number - 1),
            ColumnKey::Number(number, span) => {
                let count = there.len();
                return Err(Refusal::column_error(
                    path,
                    line,
                    *span,
                    format!("there is no column {number}; the file has {count}"),
                    None,
                ));
            }
        };
        let mut found = (there.iter().enumerate()).filter(|(_, header)| header.trim() == name);
        match (found.next(), found.next()) {
            (Some((place, _)), None) => Ok(place),
            (Some(_), Some(_)) => Err(Refusal::line_error(
                path,
                line,
                format!("there are two columns `{name}`; rename one, or give the column's number"),
            )),
            (None, _) => {
                let list = there.join(", ");
                let shown: String = list.chars().take(200).collect();
                let shown = escape_hidden(&shown);
                let parted = match guess_separator(there) {
                    _ if there[0].starts_with(COMMENT) => format!(
                        ": this line is a comment; write comment = \"{COMMENT}\" in [format], or set skip to the number of lines \
                         above the names"
                    ),
                    Some(by) => format!(": its columns are separated by {by}"),
                    None => String::new(),
                };
                Err(Refusal::column_error(
                    path,
                    line,
                    key.span(),
                    format!("there is no column `{name}`; the file has {shown}{parted}"),
                    nearest(name, there.iter().map(|header| header.trim())),
                ))
            }
        }
    };
    wanted.iter().map(place).collect()
}

/// Returns the likely separator of names that were read as one column, with a remedy.
fn guess_separator(there: &[String]) -> Option<String> {
    let [one] = there else { return None };
    let by = [
        (';', "semicolons", ";"),
        ('\t', "tabs", "tab"),
        ('|', "bars", "|"),
        (',', "commas", ","),
        (' ', "spaces", "spaces"),
    ];
    let (_, name, word) = by.into_iter().find(|(sign, _, _)| one.contains(*sign))?;
    Some(format!("{name}; write separator = \"{word}\" in [format]"))
}

pub fn too_many_samples_error(path: &Path) -> Refusal {
    Refusal::file_error(
        path,
        format!(
            "has more than {MAX_SAMPLES} samples, the maximum: split the record, or reduce its sampling rate"
        ),
    )
}
