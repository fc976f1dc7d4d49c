//! Hashes of files.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use eomgen_model_spec::source::sha256;

/// Hashes of input files, each read once.
pub struct Hashes {
    folder: PathBuf,
    known: HashMap<String, Option<String>>,
}

impl Hashes {
    /// Creates an empty cache. `folder` is the folder of the family file.
    pub fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            known: HashMap::new(),
        }
    }

    /// Returns the hash of a file; `None` if it cannot be read.
    pub fn of(&mut self, path: &str) -> Option<&str> {
        let Self { folder, known } = self;
        let hash = known
            .entry(path.to_owned())
            .or_insert_with(|| hash_file(&folder.join(path)));
        hash.as_deref()
    }
}

/// Returns the SHA-256 of a file; `None` if it cannot be read.
pub fn hash_file(path: &Path) -> Option<String> {
    std::fs::read(path).ok().map(sha256)
}
