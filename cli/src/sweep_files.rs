//! Final files of a sweep: a table, a figure for each measure, and statistics of random samples.

use std::path::PathBuf;

use eomgen_sweep::{Folder, Job, MissingNumbers, Table, merge};
use serde_json::{Value, json};

use crate::count::count;
use crate::document::SCHEMA;
use crate::error::{Error, Result, warn};
use crate::figures::draw;
use crate::output::write_file;
use crate::parquet_file::encode;
use crate::sample_statistics::{Statistics, statistics};
use crate::significant::significant;

pub struct FinalFiles {
    files: Vec<PathBuf>,
    points: usize,
    /// Number of points without a result, by measure.
    failed: Vec<(String, usize)>,
    statistics: Option<Statistics>,
    /// Table of the values of all points as text; empty if there are many points.
    values: String,
    /// True if no point has enough crossings of the Poincaré section, so that no measure has a value.
    is_without_crossings: bool,
}

/// Maximum number of points whose values are printed.
const MAX_PRINTED_POINTS: usize = 24;

/// Writes the final files, with a warning for points without a result.
///
/// # Errors
/// Missing parts, or files that cannot be written.
pub fn finish(folder: &Folder) -> Result<FinalFiles> {
    let job = folder.job();
    let table = merge(folder).map_err(|error| Error::input(error.to_string()))?;
    let missing = MissingNumbers::find(job, &table);
    let mut finished = FinalFiles {
        files: Vec::new(),
        points: job.points().count(),
        failed: failures(job, &table),
        statistics: statistics(job, &table),
        values: print_values(&table),
        is_without_crossings: missing.is_without_crossings,
    };
    if let Some(statistics) = &finished.statistics {
        for (name, svg) in statistics.figures() {
            let path = folder.path().join(name);
            write_file(&path, svg.as_bytes())?;
            finished.files.push(path);
        }
        let path = folder.path().join("statistics.json");
        write_file(&path, format!("{:#}\n", statistics.json()).as_bytes())?;
        finished.files.push(path);
    }
    for (measure, picture) in draw(job, &table) {
        match picture {
            Ok(bytes) => {
                let path = folder
                    .path()
                    .join(format!("map_{}.png", measure.replace(':', "_")));
                write_file(&path, &bytes)?;
                finished.files.push(path);
            }
            Err(error) => warn(&format!(
                "warning: the figure of {measure} cannot be drawn: {error}"
            )),
        }
    }
    let bytes = encode(&table.names, &table.columns)
        .map_err(|error| Error::input(format!("cannot write Parquet: {error}")))?;
    let path = folder.path().join("sweep.parquet");
    write_file(&path, &bytes)?;
    finished.files.push(path);
    let columns: Vec<_> = (table.names.iter().cloned().zip(table.columns)).collect();
    let path = folder.path().join("sweep.csv");
    write_file(
        &path,
        &crate::table::Table::from_columns(&columns).encode(&path)?,
    )?;
    finished.files.push(path);
    let kind = if missing.is_without_crossings {
        "error"
    } else {
        "warning"
    };
    for message in &missing.messages {
        warn(&format!("{kind}: {message}"));
    }
    Ok(finished)
}

/// Returns an aligned table of the values of all points without the status columns; empty if there are many points.
fn print_values(table: &Table) -> String {
    let points = table.columns.first().map_or(0, Vec::len);
    if points > MAX_PRINTED_POINTS {
        return String::new();
    }
    let columns = table.names.iter().zip(&table.columns);
    let columns = columns.filter(|(name, _)| !name.ends_with("_status"));
    let columns: Vec<Vec<String>> = columns
        .map(|(name, values)| {
            let values = values.iter().map(|value| significant(*value));
            std::iter::once(name.clone()).chain(values).collect()
        })
        .collect();
    let widths = columns.iter().map(|column| {
        let lengths = column.iter().map(|cell| cell.len());
        lengths.max().unwrap_or(0)
    });
    let widths: Vec<usize> = widths.collect();
    let line = |row: usize| {
        let cells = columns.iter().zip(&widths);
        let cells: Vec<String> = cells
            .map(|(column, width)| format!("{:<width$}", column[row]))
            .collect();
        format!("{}\n", cells.join("  ").trim_end())
    };
    (0..=points).map(line).collect()
}

/// Counts the points without a result, for each measure.
fn failures(job: &Job, table: &Table) -> Vec<(String, usize)> {
    let measures = job.plan().measures.iter();
    let count = |name: &str| {
        let statuses = table.column(&format!("{name}_status")).unwrap_or_default();
        statuses.iter().filter(|status| **status != 0.0).count()
    };
    measures
        .map(|measure| (measure.name.clone(), count(&measure.name)))
        .collect()
}

impl FinalFiles {
    /// Returns an error if no point has enough crossings of the Poincaré section. The message is printed together with
    /// the files.
    pub fn check(&self) -> Result {
        match self.is_without_crossings {
            true => Err(Error::Failed),
            false => Ok(()),
        }
    }

    pub fn json(&self) -> Value {
        let files = self.files.iter().map(|file| file.display().to_string());
        let failed = self.failed.iter().cloned();
        let mut document = json!({
            "schema": SCHEMA,
            "points": self.points,
            "failed": failed.collect::<std::collections::BTreeMap<_, _>>(),
            "files": files.collect::<Vec<_>>(),
        });
        if let Some(statistics) = &self.statistics {
            document["statistics"] = statistics.json();
        }
        document
    }

    pub fn text(&self) -> String {
        let mut text = format!("{}\n", count(self.points, "point"));
        text += &self.values;
        for (measure, failed) in &self.failed {
            if *failed > 0 {
                text += &format!(
                    "{measure}: {} without a number; the column {measure}_status has the reason\n",
                    count(*failed, "point")
                );
            }
        }
        if let Some(statistics) = &self.statistics {
            text += &statistics.text();
        }
        for file in &self.files {
            text += &format!("{}\n", file.display());
        }
        text
    }
}
