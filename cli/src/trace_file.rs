//! `trace.json`: for each line of an emitted file, the unit of its value and the terms of the specification from which
//! it is derived.

use eomgen_codegen::program::Program;
use eomgen_codegen::trace::find_traced_lines;
use serde_json::{Map, Value, json};

use crate::document::SCHEMA;
use crate::error::{Error, Result};

/// Name of the written file.
pub const TRACE: &str = "trace.json";

/// Returns the trace of the emitted Rust and C among `files`, given by name and content.
///
/// # Errors
/// No emitted Rust or C.
pub fn document<'f>(
    program: &Program,
    files: impl Iterator<Item = (&'f str, &'f [u8])>,
) -> Result<String> {
    let mut traced = Map::new();
    for (name, contents) in files {
        let text = String::from_utf8_lossy(contents);
        let lines = find_traced_lines(&text, &program.trace).into_iter();
        let lines = lines.map(|line| {
            json!({
                "line": line.line,
                "function": line.function,
                "name": line.name,
                "unit": line.unit,
                "terms": line.terms,
            })
        });
        let lines: Vec<Value> = lines.collect();
        if !lines.is_empty() {
            traced.insert(name.to_owned(), Value::Array(lines));
        }
    }
    if traced.is_empty() {
        return Err(Error::input(
            "--with trace needs --target rust or --target c99: other targets have no comments with values",
        ));
    }
    let guards: Vec<&str> = program.guards.iter().map(|guard| &*guard.formula).collect();
    let document = json!({
        "schema": SCHEMA,
        "model": program.name,
        "specification_sha256": program.spec_hash,
        "guards": guards,
        "files": traced,
    });
    let text = serde_json::to_string_pretty(&document);
    Ok(text.map_err(|error| Error::input(error.to_string()))? + "\n")
}
