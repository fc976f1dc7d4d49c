//! What the columns of any format have in common: their names and how many samples are read.

use std::path::Path;

use crate::refusal::Refusal;

/// The most samples of a record: some hundred times as many as are searched in minutes.
pub const MOST_SAMPLES: usize = 1_000_000;

/// Where the wanted columns stand among those that are there.
pub fn places(path: &Path, there: &[&str], wanted: &[&str]) -> Result<Vec<usize>, Refusal> {
    let place = |name: &&str| {
        let mut found = (there.iter().enumerate()).filter(|(_, header)| header.trim() == *name);
        match (found.next(), found.next()) {
            (Some((place, _)), None) => Ok(place),
            (Some(_), Some(_)) => Err(Refusal::line(
                path,
                1,
                format!("there are two columns `{name}`; give each a name of its own"),
            )),
            (None, _) => {
                let list = there.join(", ");
                let shown: String = list.chars().take(200).collect();
                Err(Refusal::line(
                    path,
                    1,
                    format!("there is no column `{name}`; there are {shown}"),
                ))
            }
        }
    };
    wanted.iter().map(place).collect()
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
