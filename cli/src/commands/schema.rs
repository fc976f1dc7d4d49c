//! `eomgen schema`: the language's JSON schema, for editors.

use eomgen_model_spec::schema::SCHEMA;

use crate::error::{Result, say_bytes};

/// Runs the command.
pub fn run() -> Result {
    say_bytes(SCHEMA.as_bytes())
}
