//! `eomgen schema`: the JSON schema of specifications.

use eomgen_model_spec::schema::SCHEMA;

use crate::error::{Result, say_bytes};

pub fn run() -> Result {
    say_bytes(SCHEMA.as_bytes())
}
