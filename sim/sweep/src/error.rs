//! Why a sweep could not be started, finished or merged.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// How many gaps a message names.
const GAPS_SHOWN: usize = 5;

/// Why a sweep could not be started, finished or merged.
#[derive(Clone, Debug, PartialEq)]
pub enum SweepError {
    /// The request makes no sense: what is wrong and what would be right.
    Request(String),
    /// A file or folder could not be read or written.
    File {
        /// `read`, `write`, ...
        action: &'static str,
        /// Which.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// The folder holds a different sweep.
    OtherJob {
        /// The folder.
        folder: PathBuf,
        /// What differs.
        differences: Vec<&'static str>,
    },
    /// A finished chunk in the folder belongs to a different sweep.
    OtherPart {
        /// The file.
        path: PathBuf,
    },
    /// A description of a job that cannot be used.
    Description {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// Chunks are missing.
    Gaps {
        /// The folder.
        folder: PathBuf,
        /// Grid points that are missing, in order, counted from 0.
        missing: Vec<Range<usize>>,
        /// How many points the grid has.
        points: usize,
    },
}

impl SweepError {
    /// A file or folder that could not be read or written.
    pub(super) fn file(action: &'static str, path: &Path, error: &dyn fmt::Display) -> Self {
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
                "{} holds a different sweep (not the same: {}); give another --out, or remove \
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
                "{}: {reason}; it is the description that `eomgen sweep` leaves, unchanged",
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
        .take(GAPS_SHOWN)
        .map(|gap| format!("{} to {}", gap.start, gap.end - 1))
        .collect();
    let more = if missing.len() > GAPS_SHOWN {
        ", ..."
    } else {
        ""
    };
    write!(
        f,
        "{}: {count} of {points} points are missing (counted from 0: {}{more}); run the missing \
         shards, or the sweep again without --shard, or copy their files into `parts`",
        folder.display(),
        shown.join(", ")
    )
}

impl std::error::Error for SweepError {}
