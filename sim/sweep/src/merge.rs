//! Merges all chunks of a job into one table.

use std::ops::Range;

use super::error::SweepError;
use super::folder::Folder;

/// Result of a sweep, in the order of its points.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Names of the columns, as in [`Job::columns`](super::Job::columns).
    pub names: Vec<String>,
    /// Columns with one number per point.
    pub columns: Vec<Vec<f64>>,
}

impl Table {
    /// Returns a column by its name.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let place = self.names.iter().position(|known| known == name)?;
        self.columns.get(place).map(Vec::as_slice)
    }
}

/// Merges all chunks and removes unfinished files of interrupted runs.
///
/// # Errors
/// Missing or damaged chunks (all are listed), parts of another job, or files that cannot be read.
pub fn merge(folder: &Folder) -> Result<Table, SweepError> {
    let job = folder.job();
    let (all, measured) = (job.points(), job.measured_count());
    let varied = job.plan().parameters.len();
    let names: Vec<String> = job
        .columns()
        .into_iter()
        .map(|column| column.name)
        .collect();
    let mut columns = vec![Vec::with_capacity(all.count()); names.len()];
    let mut missing: Vec<Range<usize>> = Vec::new();
    for chunk in 0..job.chunk_count() {
        let points = job.chunk_range(chunk);
        let Some(numbers) = folder.load(chunk)? else {
            add_gap(&mut missing, points);
            continue;
        };
        for (point, row) in points.zip(numbers.chunks(measured)) {
            for (column, (_, value)) in columns.iter_mut().zip(all.settings(point)) {
                column.push(value);
            }
            for (column, value) in columns.iter_mut().skip(varied).zip(row) {
                column.push(*value);
            }
        }
    }
    if !missing.is_empty() {
        return Err(SweepError::Gaps {
            folder: folder.path().to_owned(),
            missing,
            points: all.count(),
        });
    }
    folder.remove_unfinished_files()?;
    Ok(Table { names, columns })
}

fn add_gap(missing: &mut Vec<Range<usize>>, points: Range<usize>) {
    match missing.last_mut() {
        Some(last) if last.end == points.start => last.end = points.end,
        _ => missing.push(points),
    }
}
