//! `eomgen schema`: the language's JSON schema, for editors.

use model_spec::schema::SCHEMA;

use crate::problem::{Outcome, say};

/// Runs the command.
pub fn run() -> Outcome {
    say(SCHEMA)
}
