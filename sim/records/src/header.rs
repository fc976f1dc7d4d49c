//! What the columns of any format have in common: their names and how many samples are read.

use std::path::Path;

use eomgen_model_spec::visible::visible;

use crate::description::columns::ColumnKey;
use crate::refusal::Refusal;

/// The most samples of a record: some hundred times as many as are searched in minutes.
pub const MOST_SAMPLES: usize = 1_000_000;

/// Columns of numbers, NaN where one is missing.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// The columns.
    pub columns: Vec<Vec<f64>>,
    /// The line of each row, from 1; of files without lines as if names stood on the first.
    pub lines: Vec<u64>,
}

/// What lines often begin with that say nothing.
const COMMENT: char = '#';

/// Where the wanted columns stand among those that are there. `line`: that of the names.
pub fn places(
    path: &Path,
    line: u64,
    there: &[String],
    wanted: &[&ColumnKey],
) -> Result<Vec<usize>, Refusal> {
    let place = |key: &&ColumnKey| {
        let name = match key {
            ColumnKey::Name(name) => &name.text,
            ColumnKey::Number(number, _) if *number <= there.len() => return Ok(number - 1),
            ColumnKey::Number(number, _) => {
                let count = there.len();
                return Err(Refusal::line(
                    path,
                    line,
                    format!("there is no column {number}; there are {count}"),
                ));
            }
        };
        let mut found = (there.iter().enumerate()).filter(|(_, header)| header.trim() == name);
        match (found.next(), found.next()) {
            (Some((place, _)), None) => Ok(place),
            (Some(_), Some(_)) => Err(Refusal::line(
                path,
                line,
                format!(
                    "there are two columns `{name}`; give each a name of its own, or call it by its number"
                ),
            )),
            (None, _) => {
                let list = there.join(", ");
                let shown: String = list.chars().take(200).collect();
                let shown = visible(&shown);
                let parted = match parted(there) {
                    _ if there[0].starts_with(COMMENT) => format!(
                        ": that line says nothing of columns; write comment = \"{COMMENT}\" in [format], or skip = how many lines stand \
                         above the names"
                    ),
                    Some(by) => format!(": its columns are parted by {by}"),
                    None => String::new(),
                };
                Err(Refusal::line(
                    path,
                    line,
                    format!("there is no column `{name}`; there are {shown}{parted}"),
                ))
            }
        }
    };
    wanted.iter().map(place).collect()
}

/// By what else the names of one column are parted, with what to write.
fn parted(there: &[String]) -> Option<String> {
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

/// A record with more samples than are read.
pub fn too_many(path: &Path) -> Refusal {
    Refusal::file(
        path,
        format!(
            "has more than {MOST_SAMPLES} samples, the most that are read: cut the record, or sample it less often"
        ),
    )
}
