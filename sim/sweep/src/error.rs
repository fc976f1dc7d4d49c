//! Errors of starting, finishing and merging sweeps.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use eomgen_model_spec::argument::Argument;
use thiserror::Error;

const MAX_SHOWN_GAPS: usize = 5;

/// Error of a sweep.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SweepError {
    /// Invalid request, with cause and remedy.
    #[error("{0}")]
    Request(String),
    #[error("cannot {action} {}: {reason}", path.display())]
    /// File or folder that could not be read or written.
    File {
        /// Verb of the message: `read`, `write`, ...
        action: &'static str,
        /// Path of the file or folder.
        path: PathBuf,
        /// Error message of the operating system.
        reason: String,
    },
    /// Folder with a different sweep.
    #[error(
        "{} contains a different sweep (differences: {}); give another {}, or remove that folder",
        folder.display(),
        differences.join(", "),
        Argument::Out
    )]
    OtherJob {
        /// Path of the folder.
        folder: PathBuf,
        /// Options that differ.
        differences: Vec<String>,
    },
    #[error(
        "{} belongs to a different sweep; remove it, or give another {}",
        path.display(),
        Argument::Out
    )]
    /// Finished chunk of a different sweep.
    OtherPart {
        /// Path of the file.
        path: PathBuf,
    },
    /// Invalid description of a job.
    #[error(
        "{}: {reason}; expected the unchanged description that `eomgen sweep` wrote",
        path.display()
    )]
    Description {
        /// Path of the file.
        path: PathBuf,
        /// Problem of the description.
        reason: String,
    },
    /// Missing chunks.
    #[error("{}: {}", folder.display(), missing_points(missing, *points))]
    Gaps {
        /// Path of the folder.
        folder: PathBuf,
        /// Missing points in order, counted from 0.
        missing: Vec<Range<usize>>,
        /// Number of points.
        points: usize,
    },
}

impl From<SweepError> for eomgen_compiled_model::Error {
    fn from(error: SweepError) -> Self {
        Self::Request(error.to_string())
    }
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

fn missing_points(missing: &[Range<usize>], points: usize) -> String {
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
    format!(
        "{count} of {points} points are missing (counted from 0: {}{more}); run the missing \
         shards, run the sweep again without --shard, or copy the missing files into `parts`",
        shown.join(", ")
    )
}
