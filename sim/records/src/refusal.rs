//! Why records are not taken.

use std::path::Path;

use eomgen_model_spec::diagnostic::Diagnostics;

/// Why records are not taken: where they are wrong, what is wrong and what would be right.
#[derive(Clone, Debug)]
pub enum Refusal {
    /// The dataset file is wrong.
    Description(Diagnostics),
    /// A record is wrong: a sentence that names its file, and line where there is one.
    Record(String),
}

impl Refusal {
    /// A record that is wrong as a whole.
    pub fn file(path: &Path, message: impl std::fmt::Display) -> Self {
        Self::Record(format!("{}: {message}", path.display()))
    }

    /// A record that is wrong on a line.
    pub fn line(path: &Path, line: u64, message: impl std::fmt::Display) -> Self {
        Self::Record(format!("{}, line {line}: {message}", path.display()))
    }
}

impl From<Diagnostics> for Refusal {
    fn from(found: Diagnostics) -> Self {
        Self::Description(found)
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Description(found) => found.fmt(f),
            Self::Record(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for Refusal {}
