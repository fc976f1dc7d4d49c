//! Errors of starting, finishing and merging sweeps.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

const MAX_SHOWN_GAPS: usize = 5;

/// Error of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub enum SweepError {
    /// Invalid request, with cause and cure.
    Request(String),
    /// File or folder that could not be read or written.
    File {
        /// Verb of the message: `read`, `write`, ...
        action: &'static str,
        /// Path of the file or folder.
        path: PathBuf,
        /// Message of the system.
        reason: String,
    },
    /// Folder with a different sweep.
    OtherJob {
        /// Path of the folder.
        folder: PathBuf,
        /// Options that differ.
        differences: Vec<&'static str>,
    },
    /// Finished chunk of a different sweep.
    OtherPart {
        /// Path of the file.
        path: PathBuf,
    },
    /// Invalid description of a job.
    Description {
        /// Path of the file.
        path: PathBuf,
        /// Problem of the description.
        reason: String,
    },
    /// Missing chunks.
    Gaps {
        /// Path of the folder.
        folder: PathBuf,
        /// Missing points in order, counted from 0.
        missing: Vec<Range<usize>>,
        /// Number of points.
        points: usize,
    },
}

impl SweepError {
    pub(super) fn file_error(action: &'static str, path: &Path, error: &dyn fmt::Display) -> Self {
        Self::File {
            action,
            path: path.to_owned(),
            reason: error.to_string(),
        }
    }
}

impl fmt::Display for SweepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Request(problem) => f.write_str(problem),
            Self::File {
                action,
                path,
                reason,
            } => write!(f, "cannot {action} {}: {reason}", path.display()),
            Self::OtherJob {
                folder,
                differences,
            } => write!(
                f,
                "{} contains a different sweep (differences: {}); give another --out, or remove \
                 that folder",
                folder.display(),
                differences.join(", ")
            ),
            Self::OtherPart { path } => write!(
                f,
                "{} belongs to a different sweep; remove it, or give another --out",
                path.display()
            ),
            Self::Description { path, reason } => write!(
                f,
                "{}: {reason}; expected the unchanged description that `eomgen sweep` wrote",
                path.display()
            ),
            Self::Gaps {
                folder,
                missing,
                points,
            } => write_gaps(f, folder, missing, *points),
        }
    }
}

fn write_gaps(
    f: &mut fmt::Formatter<'_>,
    folder: &Path,
    missing: &[Range<usize>],
    points: usize,
) -> fmt::Result {
    let count: usize = missing.iter().map(ExactSizeIterator::len).sum();
    let shown: Vec<String> = missing
        .iter()
        .take(MAX_SHOWN_GAPS)
        .map(|gap| format!("{} to {}", gap.start, gap.end - 1))
        .collect();
    let more = if missing.len() > MAX_SHOWN_GAPS {
        ", ..."
    } else {
        ""
    };
    write!(
        f,
        "{}: {count} of {points} points are missing (counted from 0: {}{more}); run the missing \
         shards, run the sweep again without --shard, or copy the missing files into `parts`",
        folder.display(),
        shown.join(", ")
    )
}

impl std::error::Error for SweepError {}
