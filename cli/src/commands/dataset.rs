//! `eomgen dataset`: a proposed dataset file for a record.

use std::path::{Path, PathBuf};

use serde_json::json;

use crate::arguments::Dataset;
use crate::document::SCHEMA;
use crate::error::{Error, Result, print_bytes, print_json, print_text, warn};
use crate::model::load;
use crate::output::write_file;

pub fn run(options: &Dataset) -> Result {
    let is_specification = |path: &Path| path.extension().is_some_and(|end| end == "toml");
    if is_specification(&options.record) && !is_specification(&options.spec) {
        return Err(Error::input(format!(
            "give the record first and the specification second: eomgen dataset {} {}",
            options.spec.display(),
            options.record.display()
        )));
    }
    let model = load(&options.spec)?.model;
    let name = name(options)?;
    let text =
        eomgen_records::propose_dataset(&options.record, &name, &model).map_err(Error::records)?;
    if let Some(out) = &options.out {
        write_file(out, text.as_bytes())?;
        // Guesses may be wrong, so report the errors that `compare` would report.
        match eomgen_records::read_dataset(out, &model) {
            Ok(dataset) => dataset
                .notes
                .iter()
                .for_each(|n| warn(&format!("note: {n}"))),
            Err(refusal) => warn(&format!("note: the proposed file needs changes: {refusal}")),
        }
    }
    match (&options.out, options.output.json) {
        (out, true) => print_json(&json!({ "schema": SCHEMA, "out": out, "dataset": text })),
        (Some(out), false) => print_text(&format!(
            "{}: check the lines that are marked as guessed\n",
            out.display()
        )),
        (None, false) => print_bytes(text.as_bytes()),
    }
}

/// Returns the record's path relative to the folder of the dataset file, which is the record's folder without `--out`.
fn name(options: &Dataset) -> Result<String> {
    let record = &options.record;
    let file_name = record
        .file_name()
        .map(|name| name.to_string_lossy().into_owned());
    let file_name = file_name
        .ok_or_else(|| Error::input("the record is not a file: give the path of a file"))?;
    let Some(out) = &options.out else {
        return Ok(file_name);
    };
    let folder = match out.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let whole = |path: &Path| -> Result<PathBuf> {
        path.canonicalize()
            .map_err(|error| Error::file("read", path, &error))
    };
    let record = whole(record)?;
    let inside = folder.canonicalize().ok().and_then(|folder| {
        let inside = record.strip_prefix(folder).ok()?;
        let parts: Vec<String> = inside
            .iter()
            .map(|part| part.to_string_lossy().into_owned())
            .collect();
        Some(parts.join("/"))
    });
    inside.ok_or_else(|| {
        Error::input(format!(
            "--out {}: a dataset file must be in the folder of its records or above it; expected a file in {} or above",
            out.display(),
            record.parent().unwrap_or(Path::new("/")).display()
        ))
    })
}
