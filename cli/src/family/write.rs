//! Writes the files of a family. Each file is replaced only by a complete file. The manifest is written last.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::build::BuiltVariant;
use super::description::{Family, Precision};
use super::hashes::hash_file;
use super::interface::{self, CVariant};
use super::manifest::{self, Manifest};
use crate::arguments::Target;
use crate::emitted_files::CERTIFICATE;
use crate::error::{Error, Result, warn};
use crate::output::write_file;

/// Returns the common files of the family: the list of Rust modules with their trait, and the C tables of the variants
/// in double precision.
pub fn root_files(family: &Family) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let variants = family.variants.iter();
    let modules = variants.filter(|v| v.has(Target::Rust) && v.is_module());
    let mut text = format!(
        "//! Variants of the family `{}`, emitted by `eomgen family`. Do not edit: generate again.\n\n\
         #![allow(dead_code)]\n\n",
        family.name
    );
    for variant in modules.clone() {
        text += "#[rustfmt::skip]\n";
        if variant.prefix != variant.name {
            text += &format!("#[path = \"{}/mod.rs\"]\n", variant.name);
        }
        text += &format!("pub mod {};\n", variant.prefix);
    }
    if modules.clone().next().is_some() {
        text += &interface::rust(modules.map(|variant| &*variant.prefix));
        files.insert("mod.rs".to_owned(), text.into_bytes());
    }
    let mut in_c = Vec::new();
    for variant in family.variants.iter().filter(|v| v.has(Target::C99)) {
        let prefixes = variant.c_prefixes().into_iter();
        let double = prefixes.filter(|(_, precision)| *precision == Precision::Double);
        in_c.extend(double.map(|(prefix, _)| CVariant {
            folder: &variant.name,
            prefix,
        }));
    }
    if !in_c.is_empty() {
        let [header, source] = interface::c(&family.name, &in_c);
        files.insert("models.h".to_owned(), header.into_bytes());
        files.insert("models.c".to_owned(), source.into_bytes());
    }
    files
}

fn files<'f>(
    built: &'f [BuiltVariant],
    root: &'f BTreeMap<String, Vec<u8>>,
) -> impl Iterator<Item = (&'f String, &'f Vec<u8>)> {
    built.iter().flat_map(|built| &built.files).chain(root)
}

/// Returns the emitted files that differ from those in the folder.
pub fn different_files(
    built: &[BuiltVariant],
    root: &BTreeMap<String, Vec<u8>>,
    out: &Path,
) -> BTreeSet<String> {
    let differs = |(path, contents): &(&String, &Vec<u8>)| {
        std::fs::read(out.join(path)).map_or(true, |present| present != **contents)
    };
    files(built, root)
        .filter(differs)
        .map(|(path, _)| path.clone())
        .collect()
}

/// Texts of which an emitted file contains one, except test vectors and constants.
const MARKS: [&str; 4] = [
    "mitted by eomgen",
    "mitted by `eomgen",
    "Do not edit: generate again.",
    "\"eomgen ",
];

/// Returns true if the file contains a text of emitted files.
fn is_marked(path: &Path) -> bool {
    let text = std::fs::read(path).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    MARKS.iter().any(|mark| text.contains(mark))
}

/// Checks that no file that this program did not write would be replaced.
///
/// # Errors
/// The first file that is not in the manifest, has no text of emitted files, and is not in the folder of a variant.
pub fn check_foreign_files(
    built: &[BuiltVariant],
    root: &BTreeMap<String, Vec<u8>>,
    manifest: &Manifest,
    out: &Path,
) -> Result {
    // The folder of a variant, which contains a certificate, has no files of others.
    let is_in_variant = |place: &Path| {
        let folder = place.parent().filter(|folder| *folder != out);
        folder.is_some_and(|folder| is_marked(&folder.join(CERTIFICATE)))
    };
    let is_foreign = |path: &&String| {
        let place = out.join(path);
        place.is_file()
            && manifest.file_hash(path).is_none()
            && !is_marked(&place)
            && !is_in_variant(&place)
    };
    match different_files(built, root, out).iter().find(is_foreign) {
        None => Ok(()),
        Some(path) => Err(Error::input(format!(
            "{} exists, and `eomgen family` did not write it: move or delete the file, or give another folder with \
             --out; nothing was written",
            out.join(path).display()
        ))),
    }
}

/// Writes all files that differ.
pub fn write(built: &[BuiltVariant], root: &BTreeMap<String, Vec<u8>>, out: &Path) -> Result {
    let different = different_files(built, root, out);
    for (path, contents) in files(built, root).filter(|(path, _)| different.contains(*path)) {
        write_file(&out.join(path), contents)?;
    }
    Ok(())
}

/// Removes files of an earlier run that belong to no variant. Edited files are kept.
pub fn remove(paths: &[String], manifest: &Manifest, out: &Path) -> Result {
    for path in paths {
        let place = out.join(path);
        match hash_file(&place) {
            None => continue,
            Some(hash) if manifest.file_hash(path) == Some(&*hash) => {
                std::fs::remove_file(&place)
                    .map_err(|error| Error::file("remove", &place, &error))?;
                // Removing the folder succeeds only if it is empty.
                let _ = place.parent().map(std::fs::remove_dir);
            }
            Some(_) => warn(&format!(
                "warning: {} belongs to no variant and was edited: it is not deleted",
                place.display()
            )),
        }
    }
    Ok(())
}

/// Writes the manifest if it changed.
pub fn manifest(text: &str, out: &Path) -> Result {
    let path = out.join(manifest::FILE);
    if std::fs::read_to_string(&path).is_ok_and(|present| present == text) {
        return Ok(());
    }
    write_file(&path, text.as_bytes())
}
