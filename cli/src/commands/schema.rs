//! `eomgen schema`: the JSON schema of specifications.

use eomgen_model_spec::schema::schema;

use crate::error::{Result, print_json};

pub fn run() -> Result {
    print_json(&schema())
}
