//! `manifest.json`: hashes of specifications and emitted files, sizes, orders and operations. It contains no time stamp
//! and no absolute path.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use eomgen_model_spec::source::sha256;
use serde_json::{Value, json};

use super::build::BuiltVariant;
use super::description::{Family, Variant};
use crate::document::SCHEMA;
use crate::emitted_files::CERTIFICATE;
use crate::error::{Error, Result};

/// File name of the manifest.
pub const FILE: &str = "manifest.json";

const GENERATOR: &str = concat!("eomgen ", env!("CARGO_PKG_VERSION"));

/// Manifest of an output folder.
#[derive(Clone, Default)]
pub struct Manifest {
    /// Text as read.
    text: String,
    generator: String,
    family: String,
    /// Entries by variant names.
    variants: BTreeMap<String, Value>,
    /// Names of the variants in the order of the family file.
    order: Vec<String>,
}

impl Manifest {
    /// Reads the manifest of a folder; empty if there is none.
    ///
    /// # Errors
    /// A file that is not a manifest, or the manifest of another family.
    pub fn read(out: &Path, family: &Family) -> Result<Self> {
        let path = out.join(FILE);
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Ok(Self::default());
            }
            Err(error) => return Err(Error::file("read", &path, &error)),
        };
        let cure =
            "restore the file, or delete it to generate all variants again; nothing was written";
        let shown = path.display();
        let document: Value = serde_json::from_str(&text).map_err(|error| {
            let (line, column) = (error.line(), error.column());
            Error::input(format!(
                "{shown}:{line}:{column}: the manifest is truncated or edited: {error}; {cure}"
            ))
        })?;
        let wrong = |what: &str| Error::input(format!("{shown}: {what}; {cure}"));
        let variants = document["variants"]
            .as_array()
            .ok_or_else(|| wrong("this is not a manifest of a family"))?;
        let name = document["family"]
            .as_str()
            .ok_or_else(|| wrong("this is not a manifest of a family"))?;
        if name != family.name {
            return Err(Error::input(format!(
                "{} contains the family `{name}`, not `{}`: give another folder",
                out.display(),
                family.name
            )));
        }
        let named = variants
            .iter()
            .filter_map(|entry| Some((entry["name"].as_str()?.to_owned(), entry.clone())));
        let named: Vec<(String, Value)> = named.collect();
        Ok(Self {
            generator: document["generator"]
                .as_str()
                .unwrap_or_default()
                .to_owned(),
            family: name.to_owned(),
            order: named.iter().map(|(name, _)| name.clone()).collect(),
            variants: named.into_iter().collect(),
            text,
        })
    }

    /// Prepares the manifest of a new run: removes variants that the family no longer has.
    pub fn begin(&mut self, family: &Family) {
        GENERATOR.clone_into(&mut self.generator);
        self.family.clone_from(&family.name);
        self.order = family
            .variants
            .iter()
            .map(|variant| variant.name.clone())
            .collect();
        self.variants.retain(|name, _| self.order.contains(name));
    }

    /// Sets the entry of a variant.
    pub fn insert(&mut self, variant: &Variant, built: &BuiltVariant) {
        let file = |(path, contents): (&String, &Vec<u8>)| {
            (
                path.clone(),
                json!({"sha256": sha256(contents), "bytes": contents.len()}),
            )
        };
        let entry = json!({
            "name": variant.name,
            "definition": variant.definition(),
            "model": built.model,
            "orders": built.orders,
            "states": built.states,
            "inputs": built.inputs,
            "files": built.files.iter().map(file).collect::<serde_json::Map<_, _>>(),
            "operations": built.operations,
            "verdict": built.verdict,
        });
        self.variants.insert(variant.name.clone(), entry);
    }

    /// Copies hash and verdict from an earlier manifest if `path` is a certificate.
    pub fn keep_certificate(&mut self, earlier: &Self, path: &str) {
        let Some((name, CERTIFICATE)) = path.split_once('/') else {
            return;
        };
        let entries = (self.variants.get_mut(name), earlier.entry(name));
        if let (Some(entry), Some(earlier)) = entries {
            entry["files"][path] = earlier["files"][path].clone();
            entry["verdict"] = earlier["verdict"].clone();
        }
    }

    /// Returns the text of the manifest file; empty if there is no file.
    pub fn read_text(&self) -> &str {
        &self.text
    }

    /// Returns the manifest as JSON text.
    pub fn text(&self) -> String {
        let entries = self.order.iter().filter_map(|name| self.variants.get(name));
        let document = json!({
            "schema": SCHEMA,
            "family": self.family,
            "generator": self.generator,
            "variants": entries.collect::<Vec<_>>(),
        });
        format!("{document:#}\n")
    }

    /// Returns the entry of a variant.
    pub fn entry(&self, name: &str) -> Option<&Value> {
        self.variants.get(name)
    }

    /// Returns true if this version of the generator wrote the manifest.
    pub fn is_current_generator(&self) -> bool {
        self.generator == GENERATOR
    }

    /// Returns the version of the generator.
    pub fn generator(&self) -> &str {
        &self.generator
    }

    /// Returns the operation counts of a variant, by function.
    pub fn operations(&self, name: &str) -> Value {
        self.entry(name)
            .map_or(Value::Null, |entry| entry["operations"].clone())
    }

    /// Returns the verdict of a variant's certificate.
    pub fn verdict(&self, name: &str) -> Option<&str> {
        self.entry(name)?["verdict"].as_str()
    }

    /// Returns the paths of all files.
    pub fn files(&self) -> BTreeSet<String> {
        let files = self
            .variants
            .values()
            .filter_map(|entry| entry["files"].as_object());
        files.flat_map(|files| files.keys().cloned()).collect()
    }

    /// Returns the number of emitted files and certificates, including the manifest.
    pub fn file_count(&self) -> usize {
        self.files().len() + 1
    }

    /// Returns the files that a later manifest does not contain.
    pub fn files_not_in(&self, later: &Self, root: &BTreeMap<String, Vec<u8>>) -> Vec<String> {
        let kept = later.files();
        let is_gone = |path: &String| !kept.contains(path) && !root.contains_key(path);
        self.files().into_iter().filter(is_gone).collect()
    }

    /// Returns the hash of a file.
    pub fn file_hash(&self, path: &str) -> Option<&str> {
        let name = path.split('/').next()?;
        self.entry(name)?["files"][path]["sha256"].as_str()
    }
}
