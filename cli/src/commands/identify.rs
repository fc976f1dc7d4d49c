//! `eomgen identify`: lists emitted variants in an object file, a library or a firmware image, by their identity
//! symbols.

use std::path::{Path, PathBuf};

use eomgen_codegen::identity::{Identity, find};
use serde_json::{Value, json};

use crate::arguments::Identify;
use crate::document::SCHEMA;
use crate::emitted_files::CERTIFICATE;
use crate::error::{Error, Result, print_json, print_text, warn};
use crate::input_file::read_file;

/// Maximum depth of folders that are searched for certificates.
const MAX_DEPTH: usize = 8;

pub fn run(options: &Identify) -> Result {
    let identities = find(&read_file(&options.image)?);
    let certificates = match &options.certificates {
        Some(folder) if !folder.is_dir() => {
            return Err(Error::input(format!(
                "--certificates {}: this is not a folder",
                folder.display()
            )));
        }
        Some(folder) => certificates(folder, MAX_DEPTH),
        None => Vec::new(),
    };
    let certificate = |identity: &Identity| {
        let covers = |(_, hashes): &&(PathBuf, Vec<String>)| hashes.contains(&identity.source);
        certificates
            .iter()
            .find(covers)
            .map(|(path, _)| path.display().to_string())
    };
    if options.output.json {
        let entry = |identity: &Identity| {
            json!({
                "name": identity.name,
                "specification_sha256": identity.specification,
                "source_sha256": identity.source,
                "generator": identity.generator,
                "certificate": certificate(identity),
            })
        };
        let found: Vec<Value> = identities.iter().map(entry).collect();
        print_json(
            &json!({"schema": SCHEMA, "image": options.image.display().to_string(), "variants": found}),
        )?;
    } else {
        for identity in &identities {
            let Identity {
                name,
                specification,
                source,
                generator,
            } = identity;
            let mut text = format!(
                "{name}: eomgen {generator}\n  specification {specification}\n  source {source}\n"
            );
            match certificate(identity) {
                Some(path) => text += &format!("  certificate {path}\n"),
                None if options.certificates.is_some() => text += "  certificate not found\n",
                None => {}
            }
            print_text(&text)?;
        }
    }
    if identities.is_empty() {
        warn(&format!(
            "error: {} contains no identity: no emitted code, or code emitted without identities",
            options.image.display()
        ));
        return Err(Error::Failed);
    }
    let is_missing =
        |identity: &Identity| options.certificates.is_some() && certificate(identity).is_none();
    match identities.iter().any(is_missing) {
        true => Err(Error::Failed),
        false => Ok(()),
    }
}

/// Returns the certificates in a folder with the hashes of their sources, in the order of their paths.
fn certificates(folder: &Path, depth: usize) -> Vec<(PathBuf, Vec<String>)> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    let mut found = Vec::new();
    for path in paths {
        if path.is_dir() && !path.is_symlink() && depth > 0 {
            found.extend(certificates(&path, depth - 1));
        } else if path.file_name().is_some_and(|name| name == CERTIFICATE) {
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            let document: Value = serde_json::from_str(&text).unwrap_or_default();
            let hashes = document["identities"].as_array().into_iter().flatten();
            let hashes = hashes.filter_map(|hash| hash.as_str().map(str::to_owned));
            found.push((path, hashes.collect()));
        }
    }
    found
}
