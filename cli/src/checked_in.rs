//! `eomgen generate --all`: the checked-in variants and their certificates.

use std::path::{Path, PathBuf};

use eomgen_codegen::rust::Packaging;
use eomgen_model_spec::model::Model;
use eomgen_validate::model_certificate::{certify_source, unchecked_certificate};
use serde_json::{Value, json};

use crate::certification::document;
use crate::count::count;
use crate::document::SCHEMA;
use crate::emission::source;
use crate::error::{Error, Result, print_json, print_text, warn};
use crate::model::{derive, load};
use crate::output::write_file;
use crate::progress::Note;

const SPECIFICATION: &str = "model-spec/models/planetary_arm.toml";

const FOLDER: &str = "generated/src";
const CERTIFICATES: &str = "generated/certificates";

const HIGHEST_ORDER: usize = 8;

struct CheckedInVariant {
    name: String,
    order: usize,
    text: String,
}

/// Writes all variants, or compares them if `check` is set.
pub fn run(check: bool, json: bool) -> Result {
    let root = project_root()?;
    let model = load(&root.join(SPECIFICATION))?.model;
    let variants = variants(&model)?;
    let mut different = different_sources(&root, &variants, check)?;
    for variant in &variants {
        let path = root.join(certificate_file(variant));
        if check {
            if !is_certificate_of(&path, &model, variant)? {
                different.push(certificate_file(variant));
            }
        } else {
            let _note = Note::new(format!("certifying {}", variant.name));
            let orders = vec![variant.order; model.fields.len()];
            let text = document(&certify_source(&model, &orders, &[], variant.text.clone())?)?;
            if std::fs::read_to_string(&path).unwrap_or_default() != text {
                different.push(certificate_file(variant));
                write_file(&path, text.as_bytes())?;
            }
        }
    }
    print_differences(2 * variants.len() + 1, &different, check, json)?;
    if check && !different.is_empty() {
        warn(&format!(
            "error: files differ from the emitted ones: {}; run `eomgen generate --all`",
            different.join(", ")
        ));
        return Err(Error::Failed);
    }
    Ok(())
}

/// Returns the names of sources that differ from the emitted ones, and writes these unless `check` is set.
fn different_sources(
    root: &Path,
    variants: &[CheckedInVariant],
    check: bool,
) -> Result<Vec<String>> {
    let mut different = Vec::new();
    let root_module = [("lib.rs".to_owned(), root_module(variants))];
    let files = variants
        .iter()
        .map(|variant| (format!("{}.rs", variant.name), variant.text.clone()));
    for (name, text) in files.chain(root_module) {
        let path = root.join(FOLDER).join(&name);
        if std::fs::read_to_string(&path).unwrap_or_default() != text {
            different.push(name);
            if !check {
                write_file(&path, text.as_bytes())?;
            }
        }
    }
    Ok(different)
}

fn print_differences(files: usize, different: &[String], check: bool, json: bool) -> Result {
    if json {
        let document =
            json!({"schema": SCHEMA, "files": files, "different": different, "written": !check});
        return print_json(&document);
    }
    let verb = if check { "differ" } else { "written" };
    print_text(&format!(
        "{}, {} {verb}\n",
        count(files, "file"),
        different.len()
    ))
}

fn certificate_file(variant: &CheckedInVariant) -> String {
    format!("{CERTIFICATES}/{}.json", variant.name)
}

/// Returns whether a file is a passed certificate of a variant. Its hashes identify specification and source; no
/// check runs.
fn is_certificate_of(path: &Path, model: &Model, variant: &CheckedInVariant) -> Result<bool> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let found: Value = serde_json::from_str(&text).unwrap_or_default();
    let expected = unchecked_certificate(model, variant.order, &[], variant.text.clone())
        .map_err(|error| Error::model(&model.source, error))?;
    let expected =
        serde_json::to_value(expected).map_err(|error| Error::input(error.to_string()))?;
    let same = |(key, value): (&String, &Value)| {
        ["passed", "verdict", "coverage", "checks"].contains(&key.as_str()) || found[key] == *value
    };
    let all = expected
        .as_object()
        .is_some_and(|fields| fields.iter().all(same));
    Ok(all && found["passed"] == true)
}

fn variants(model: &Model) -> Result<Vec<CheckedInVariant>> {
    let variant = |order: usize| {
        let name = match order {
            0 => format!("{}_rigid", model.name),
            order => format!("{}_order_{order}", model.name),
        };
        let derived = derive(model.clone(), &vec![order; model.fields.len()])?;
        let text = source(derived.program(), Packaging::Module)?;
        Ok(CheckedInVariant { name, order, text })
    };
    (0..=HIGHEST_ORDER).map(variant).collect()
}

/// Returns the root module of the crate `generated`.
fn root_module(variants: &[CheckedInVariant]) -> String {
    let header = "//! Equations of motion of the planetary arm, rigid and with one to eight modes, as\n\
                  //! emitted by `eomgen generate --all`. Do not edit: regenerate.\n\n\
                  #![no_std]\n\n";
    let module =
        |variant: &CheckedInVariant| format!("#[rustfmt::skip]\npub mod {};\n", variant.name);
    header.to_owned() + &variants.iter().map(module).collect::<String>()
}

/// Finds the project's folder: the current one or one above it.
fn project_root() -> Result<PathBuf> {
    let current = std::env::current_dir()
        .map_err(|error| Error::input(format!("no current folder: {error}")))?;
    current
        .ancestors()
        .find(|folder| folder.join(SPECIFICATION).is_file() && folder.join(FOLDER).is_dir())
        .map(Path::to_path_buf)
        .ok_or_else(|| {
            Error::input(format!(
                "--all needs the project's folder: neither the current folder nor one above contains {SPECIFICATION} and {FOLDER}"
            ))
        })
}
