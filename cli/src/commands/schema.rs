//! `eomgen schema`: the JSON schema of specifications.

use eomgen_model_spec::schema::SCHEMA;

use crate::error::{Result, print_bytes};

pub fn run() -> Result {
    print_bytes(SCHEMA.as_bytes())
}
