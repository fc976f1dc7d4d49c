//! Errors, messages and exit statuses: 2 for a usage or input error, 1 if a command ran and its result is negative.

use std::io::{IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;

use eomgen_codegen::rust::EmitError;
use eomgen_discover::error::DiscoverError;
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, Severity};
use eomgen_model_spec::hidden_characters::{escape_hidden, escape_hidden_in_strings};
use eomgen_model_spec::source::Source;
use eomgen_model_spec::variant::ModelError;
use eomgen_page::play::Unplayable;
use eomgen_records::Refusal;
use eomgen_targets::EmissionError;
use serde_json::{Value, json};

use crate::document::SCHEMA;

pub type Result<T = (), E = Error> = std::result::Result<T, E>;

pub enum Error {
    /// Usage or input error; the message contains the remedy.
    Input(String),
    /// Diagnostics of a specification or dataset file.
    Specification(Diagnostics),
    /// Negative result with a message.
    Stopped(String),
    /// Negative result whose messages are already printed.
    Failed,
}

impl From<eomgen_compiled_model::Error> for Error {
    fn from(error: eomgen_compiled_model::Error) -> Self {
        use eomgen_compiled_model::Error as Model;
        match error {
            Model::Specification(found) => Self::Specification(found),
            Model::Request(reason) | Model::Stopped { reason, .. } => Self::Input(reason),
        }
    }
}

impl From<EmissionError> for Error {
    fn from(error: EmissionError) -> Self {
        match error {
            EmissionError::Request(reason) => Self::Input(reason),
            EmissionError::Specification(found) => Self::Specification(found),
        }
    }
}

impl From<Unplayable> for Error {
    fn from(error: Unplayable) -> Self {
        Self::input(error.to_string())
    }
}

impl From<EmitError> for Error {
    fn from(error: EmitError) -> Self {
        Self::Input(error.to_string())
    }
}

impl Error {
    pub fn input(message: impl Into<String>) -> Self {
        Self::Input(message.into())
    }

    pub fn file(action: &str, path: &Path, error: &dyn std::fmt::Display) -> Self {
        Self::Input(format!("cannot {action} {}: {error}", path.display()))
    }

    /// Creates the error of a model whose values are invalid.
    pub fn model(source: &Source, error: ModelError) -> Self {
        Self::Specification(Diagnostics::from_one(source.clone(), error.diagnostic()))
    }

    /// Creates the error of rejected records.
    pub fn records(refusal: Refusal) -> Self {
        match refusal {
            Refusal::Description(found) => Self::Specification(found),
            Refusal::Record(message) => Self::Input(message),
            Refusal::Column(missing) => Self::Input(missing.message),
        }
    }

    /// Creates the error of a comparison or a discovery.
    pub fn discovery(error: DiscoverError) -> Self {
        match error {
            DiscoverError::Records(refusal) => Self::records(*refusal),
            DiscoverError::Model(error) => Self::from(*error),
            other => Self::Input(other.to_string()),
        }
    }

    /// Returns the document that `--json` prints for an error; `None` if the command already printed a document.
    pub fn to_json(&self) -> Option<Value> {
        let (message, diagnostics) = match self {
            Self::Input(message) => {
                let message = message.strip_prefix("error: ").unwrap_or(message);
                (message.to_owned(), json!([]))
            }
            Self::Specification(found) => {
                let is_error = |finding: &&Diagnostic| finding.severity == Severity::Error;
                let first = found.list().iter().find(is_error);
                let message = first.map(|finding| finding.message.clone());
                (message.unwrap_or_default(), json!(found.records()))
            }
            Self::Stopped(message) => (message.clone(), json!([])),
            Self::Failed => return None,
        };
        let error = json!({ "message": message, "diagnostics": diagnostics });
        Some(json!({ "schema": SCHEMA, "error": error }))
    }

    /// Prints the error to stderr and returns the exit status.
    pub fn report(&self) -> ExitCode {
        match self {
            Self::Input(message) => {
                // Messages of some libraries are rendered diagnostics with the prefix `error: `.
                let message = message.strip_prefix("error: ").unwrap_or(message);
                warn(&format!("error: {message}"));
            }
            Self::Specification(diagnostics) => print_diagnostics(diagnostics),
            Self::Stopped(message) => {
                warn(&format!("error: {message}"));
                return ExitCode::from(1);
            }
            Self::Failed => return ExitCode::from(1),
        }
        ExitCode::from(2)
    }
}

/// Prints a message to stderr, with escaped control characters. Write errors are ignored.
pub fn warn(text: &str) {
    let _ = writeln!(std::io::stderr(), "{}", escape_hidden(text));
}

/// Prints diagnostics to stderr, with colours on a terminal.
pub fn print_diagnostics(findings: &Diagnostics) {
    let mut stderr = std::io::stderr();
    let text = findings.render(stderr.is_terminal());
    let _ = writeln!(stderr, "{text}");
}

/// Prints text to stdout, with escaped control characters. A closed pipe is not an error.
pub fn print_text(text: &str) -> Result {
    print_bytes(escape_hidden(text).as_bytes())
}

/// Prints a JSON document to stdout, with escaped control characters.
pub fn print_json(document: &serde_json::Value) -> Result {
    let text = format!("{document:#}\n");
    print_bytes(escape_hidden_in_strings(&text).as_bytes())
}

/// Prints bytes to stdout. A closed pipe is not an error.
pub fn print_bytes(bytes: &[u8]) -> Result {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(Error::input(format!("cannot write to stdout: {error}"))),
    }
}
