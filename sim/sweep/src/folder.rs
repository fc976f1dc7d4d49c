//! Folder of a sweep: `sweep.json`, the description of the job, and `parts`, with one file per
//! finished chunk. Files are written under a temporary name and then renamed, so that an
//! interruption leaves only complete files.
//!
//! Several processes can work in one folder, each on a separate shard.

use std::fs;
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::error::SweepError;
use super::job::{Job, Plan};
use super::part::{self, PartState};

const DESCRIPTION_FILE: &str = "sweep.json";

const PARTS_FOLDER: &str = "parts";

const UNFINISHED_SUFFIX: &str = ".unfinished";

const MAX_DESCRIPTION_BYTES: u64 = 16 << 20;

#[derive(Serialize, Deserialize)]
struct StoredDescription {
    hash: String,
    plan: Plan,
}

/// Folder of one job.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    job: Job,
}

impl Folder {
    /// Opens the folder of a job and creates it if it is missing.
    ///
    /// # Errors
    /// A folder with another job, or one that cannot be created or written to.
    pub fn open(path: &Path, job: Job) -> Result<Self, SweepError> {
        let description = path.join(DESCRIPTION_FILE);
        if description.exists() {
            let found = Self::open_existing(path)?;
            if found.job.hash() != job.hash() {
                return Err(SweepError::OtherJob {
                    folder: path.to_owned(),
                    differences: found.job.plan().differences(job.plan()),
                });
            }
        }
        let folder = Self {
            path: path.to_owned(),
            job,
        };
        let parts = path.join(PARTS_FOLDER);
        fs::create_dir_all(&parts)
            .map_err(|error| SweepError::file_error("create", &parts, &error))?;
        if !description.exists() {
            folder.write_atomically(&description, folder.read_description()?.as_bytes())?;
        }
        Ok(folder)
    }

    /// Opens the folder of an existing job.
    ///
    /// # Errors
    /// A missing or modified description.
    pub fn open_existing(path: &Path) -> Result<Self, SweepError> {
        let file = path.join(DESCRIPTION_FILE);
        let bytes = read_limited(&file, MAX_DESCRIPTION_BYTES)?;
        let refused = |reason: String| SweepError::Description {
            path: file.clone(),
            reason,
        };
        let stored: StoredDescription =
            serde_json::from_slice(&bytes).map_err(|error| refused(error.to_string()))?;
        let job = Job::new(stored.plan).map_err(|error| refused(error.to_string()))?;
        if job.hash() != stored.hash {
            return Err(refused("the plan does not match its hash".to_owned()));
        }
        Ok(Self {
            path: path.to_owned(),
            job,
        })
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the job.
    pub fn job(&self) -> &Job {
        &self.job
    }

    fn read_description(&self) -> Result<String, SweepError> {
        let stored = StoredDescription {
            hash: self.job.hash().to_owned(),
            plan: self.job.plan().clone(),
        };
        serde_json::to_string_pretty(&stored)
            .map(|text| text + "\n")
            .map_err(|error| {
                SweepError::file_error("write", &self.path.join(DESCRIPTION_FILE), &error)
            })
    }

    /// Returns true if a chunk is complete.
    ///
    /// # Errors
    /// A part of another job, or a file that cannot be read.
    pub fn has_chunk(&self, chunk: usize) -> Result<bool, SweepError> {
        let path = self.part_path(chunk);
        let failed = |error| SweepError::file_error("read", &path, &error);
        let file = match fs::File::open(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
            opened => opened.map_err(failed)?,
        };
        let length = file.metadata().map_err(failed)?.len();
        let mut start = Vec::new();
        file.take(part::header_length(&self.job) as u64)
            .read_to_end(&mut start)
            .map_err(failed)?;
        match part::inspect_part(&self.job, chunk, length, &start) {
            PartState::Complete => Ok(true),
            PartState::Damaged => Ok(false),
            PartState::OtherJob => Err(SweepError::OtherPart { path }),
        }
    }

    /// Reads the numbers of a chunk, point by point; `None` if it is missing or damaged.
    pub(super) fn load(&self, chunk: usize) -> Result<Option<Vec<f64>>, SweepError> {
        if !self.has_chunk(chunk)? {
            return Ok(None);
        }
        let bytes = read_limited(&self.part_path(chunk), u64::MAX)?;
        Ok(part::decode(&self.job, chunk, &bytes))
    }

    pub(super) fn store(&self, chunk: usize, numbers: &[f64]) -> Result<(), SweepError> {
        let text = part::encode(&self.job, chunk, numbers);
        self.write_atomically(&self.part_path(chunk), text.as_bytes())
    }

    /// Removes files of interrupted runs. Every chunk must be complete, and no process may write to the folder.
    pub(super) fn remove_unfinished_files(&self) -> Result<(), SweepError> {
        let parts = self.path.join(PARTS_FOLDER);
        let failed = |error| SweepError::file_error("clean up", &parts, &error);
        for entry in fs::read_dir(&parts).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            if entry
                .file_name()
                .to_string_lossy()
                .ends_with(UNFINISHED_SUFFIX)
            {
                fs::remove_file(entry.path()).map_err(failed)?;
            }
        }
        Ok(())
    }

    fn part_path(&self, chunk: usize) -> PathBuf {
        self.path
            .join(PARTS_FOLDER)
            .join(format!("{chunk:04}.part"))
    }

    fn write_atomically(&self, path: &Path, bytes: &[u8]) -> Result<(), SweepError> {
        let failed = |error: std::io::Error| SweepError::file_error("write", path, &error);
        let mut file = tempfile::Builder::new()
            .suffix(UNFINISHED_SUFFIX)
            .tempfile_in(self.path.join(PARTS_FOLDER))
            .map_err(failed)?;
        file.write_all(bytes).map_err(failed)?;
        make_readable(file.as_file()).map_err(failed)?;
        file.persist(path).map_err(|error| failed(error.error))?;
        Ok(())
    }
}

fn read_limited(path: &Path, limit: u64) -> Result<Vec<u8>, SweepError> {
    let failed = |error| SweepError::file_error("read", path, &error);
    let file = fs::File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    file.take(limit).read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}

/// Makes a temporary file readable for other users; by default it is private.
#[cfg(unix)]
fn make_readable(file: &fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn make_readable(_file: &fs::File) -> std::io::Result<()> {
    Ok(())
}
