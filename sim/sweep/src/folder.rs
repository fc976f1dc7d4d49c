//! The folder of a sweep: `sweep.json`, the description of the job, and `parts`, one file
//! per finished chunk. Files are written beside their place and moved there when whole, so
//! that a kill at any time leaves whole files only.
//!
//! Several processes may work in one folder, each on a shard of its own.

use std::fs;
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::error::SweepError;
use super::job::{Job, Plan};
use super::part::{self, Found};

/// The description's name.
const DESCRIPTION: &str = "sweep.json";

/// The parts' folder.
const PARTS: &str = "parts";

/// How files end that are being written.
const UNFINISHED: &str = ".unfinished";

/// The largest description accepted, in bytes.
const LARGEST_DESCRIPTION: u64 = 16 << 20;

/// What stands in `sweep.json`.
#[derive(Serialize, Deserialize)]
struct Stored {
    hash: String,
    plan: Plan,
}

/// The folder of one job.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    job: Job,
}

impl Folder {
    /// The folder at `path` for a job, made if it is not there.
    ///
    /// # Errors
    /// A folder that holds another job, or that cannot be made or written to.
    pub fn open(path: &Path, job: Job) -> Result<Self, SweepError> {
        let description = path.join(DESCRIPTION);
        if description.exists() {
            let found = Self::existing(path)?;
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
        let parts = path.join(PARTS);
        fs::create_dir_all(&parts).map_err(|error| SweepError::file("make", &parts, &error))?;
        if !description.exists() {
            folder.write(&description, folder.description()?.as_bytes())?;
        }
        Ok(folder)
    }

    /// The folder of a job begun before.
    ///
    /// # Errors
    /// No description there, or one that is not as it was written.
    pub fn existing(path: &Path) -> Result<Self, SweepError> {
        let file = path.join(DESCRIPTION);
        let bytes = read(&file, LARGEST_DESCRIPTION)?;
        let refused = |reason: String| SweepError::Description {
            path: file.clone(),
            reason,
        };
        let stored: Stored =
            serde_json::from_slice(&bytes).map_err(|error| refused(error.to_string()))?;
        let job = Job::new(stored.plan).map_err(|error| refused(error.to_string()))?;
        if job.hash() != stored.hash {
            return Err(refused("the plan does not have the hash given".to_owned()));
        }
        Ok(Self {
            path: path.to_owned(),
            job,
        })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The job.
    pub fn job(&self) -> &Job {
        &self.job
    }

    /// The text of `sweep.json`.
    fn description(&self) -> Result<String, SweepError> {
        let stored = Stored {
            hash: self.job.hash().to_owned(),
            plan: self.job.plan().clone(),
        };
        serde_json::to_string_pretty(&stored)
            .map(|text| text + "\n")
            .map_err(|error| SweepError::file("write", &self.path.join(DESCRIPTION), &error))
    }

    /// Whether a chunk is there, whole.
    ///
    /// # Errors
    /// A part of another job in its place, or a file that cannot be read.
    pub fn holds(&self, chunk: usize) -> Result<bool, SweepError> {
        let path = self.part(chunk);
        let failed = |error| SweepError::file("read", &path, &error);
        let file = match fs::File::open(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
            opened => opened.map_err(failed)?,
        };
        let length = file.metadata().map_err(failed)?.len();
        let mut start = Vec::new();
        file.take(part::header_length(&self.job) as u64)
            .read_to_end(&mut start)
            .map_err(failed)?;
        match part::judge(&self.job, chunk, length, &start) {
            Found::Whole => Ok(true),
            Found::Damaged => Ok(false),
            Found::Other => Err(SweepError::OtherPart { path }),
        }
    }

    /// The numbers of a chunk, point by point; `None` where it is missing or damaged.
    pub(super) fn load(&self, chunk: usize) -> Result<Option<Vec<f64>>, SweepError> {
        if !self.holds(chunk)? {
            return Ok(None);
        }
        let bytes = read(&self.part(chunk), u64::MAX)?;
        Ok(part::decode(&self.job, chunk, &bytes))
    }

    /// Writes a finished chunk.
    pub(super) fn store(&self, chunk: usize, numbers: &[f64]) -> Result<(), SweepError> {
        let text = part::encode(&self.job, chunk, numbers);
        self.write(&self.part(chunk), text.as_bytes())
    }

    /// Removes what kills have left unfinished; for when every chunk is there and nobody
    /// writes any more.
    pub(super) fn tidy(&self) -> Result<(), SweepError> {
        let parts = self.path.join(PARTS);
        let failed = |error| SweepError::file("tidy", &parts, &error);
        for entry in fs::read_dir(&parts).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            if entry.file_name().to_string_lossy().ends_with(UNFINISHED) {
                fs::remove_file(entry.path()).map_err(failed)?;
            }
        }
        Ok(())
    }

    fn part(&self, chunk: usize) -> PathBuf {
        self.path.join(PARTS).join(format!("{chunk:04}.part"))
    }

    /// Writes beside the parts, then moves into place.
    fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), SweepError> {
        let failed = |error: std::io::Error| SweepError::file("write", path, &error);
        let mut file = tempfile::Builder::new()
            .suffix(UNFINISHED)
            .tempfile_in(self.path.join(PARTS))
            .map_err(failed)?;
        file.write_all(bytes).map_err(failed)?;
        make_readable(file.as_file()).map_err(failed)?;
        file.persist(path).map_err(|error| failed(error.error))?;
        Ok(())
    }
}

fn read(path: &Path, limit: u64) -> Result<Vec<u8>, SweepError> {
    let failed = |error| SweepError::file("read", path, &error);
    let file = fs::File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    file.take(limit).read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}

/// Temporary files are private; parts are to be collected by others.
#[cfg(unix)]
fn make_readable(file: &fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn make_readable(_file: &fs::File) -> std::io::Result<()> {
    Ok(())
}
