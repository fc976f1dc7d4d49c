//! `eomgen family`: all variants of a family file, with certificates and a manifest.
//!
//! `description` reads the family file, `build` emits and certifies one variant, `manifest` stores `hashes` and
//! operation counts, `comparison` lists differences, `write` replaces files.

mod build;
mod collisions;
mod comparison;
mod description;
mod hashes;
mod interface;
mod manifest;
mod options;
mod write;

use std::collections::BTreeSet;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::json;

use crate::count::count;
use crate::document::SCHEMA;
use crate::error::{Error, Result, print_json, print_text, warn};
use crate::progress::Note;
use build::{BuiltVariant, build};
use comparison::{Findings, changes, compare_built, table};
use description::{Family, Variant};
use hashes::Hashes;
use manifest::Manifest;

pub use options::Options;

/// Maximum number of variants that are generated in parallel.
const MAX_THREADS: usize = 8;

/// Writes or compares the variants of a family.
pub fn run(options: &Options<'_>) -> Result {
    let family = description::read(options.file)?;
    let manifest = Manifest::read(options.out, &family)?;
    let mut hashes = Hashes::new(family.folder());
    let mut findings: Vec<Findings> = Vec::with_capacity(family.variants.len());
    for variant in &family.variants {
        findings.push(changes(variant, &manifest, &mut hashes, options.out));
    }
    let is_chosen = |found: &Findings| options.force || !found.is_empty();
    let chosen: Vec<usize> = (0..findings.len())
        .filter(|index| is_chosen(&findings[*index]))
        .collect();
    let root = write::root_files(&family);
    if !options.check {
        write::check_foreign_files(&[], &root, &manifest, options.out)?;
    }
    let built = build_all(&family, &chosen, options)?;
    collisions::check_declarations(&family, &built, options.out)?;
    let mut result = manifest.clone();
    result.begin(&family);
    for (index, built) in chosen.iter().zip(&built) {
        let variant = &family.variants[*index];
        compare_built(
            variant,
            built,
            &manifest,
            options,
            family.growth,
            &mut findings[*index],
        );
        result.insert(variant, built);
    }
    let mut different: BTreeSet<String> = write::different_files(&built, &root, options.out);
    let removed = manifest.files_not_in(&result, &root);
    for path in removed
        .iter()
        .filter(|path| options.out.join(path).is_file())
    {
        different.insert(path.clone());
    }
    different.extend(findings.iter().flat_map(Findings::edited_files));
    let text = result.text();
    // An edited certificate changes its own hash and verdict, but not the manifest of a new run.
    let mut expected = result.clone();
    for path in different.iter().filter(|_| options.check) {
        expected.keep_certificate(&manifest, path);
    }
    if manifest.read_text() != expected.text() {
        different.insert(manifest::FILE.to_owned());
    }
    let failed: Vec<&str> = (built.iter())
        .filter(|built| !built.passed)
        .map(|b| &*b.name)
        .collect();
    let is_written = !options.check && failed.is_empty();
    if is_written {
        write::check_foreign_files(&built, &root, &manifest, options.out)?;
        write::write(&built, &root, options.out)?;
        write::remove(&removed, &manifest, options.out)?;
        write::manifest(&text, options.out)?;
    }
    print(&family, &result, &findings, &different, is_written, options)?;
    if !failed.is_empty() {
        warn(&format!(
            "error: the certificates of {} did not pass; nothing was written",
            failed.join(", ")
        ));
        return Err(Error::Failed);
    }
    let is_different = !different.is_empty() || findings.iter().any(|found| !found.is_empty());
    if options.check && is_different {
        let shown: Vec<&str> = different.iter().map(String::as_str).take(12).collect();
        warn(&format!(
            "error: {} {}: {}{}; run the command without --check",
            count(different.len(), "file"),
            differ(different.len()),
            shown.join(", "),
            if different.len() > shown.len() {
                " and others"
            } else {
                ""
            },
        ));
        return Err(Error::Failed);
    }
    Ok(())
}

/// Returns the verb form for a number of files.
fn differ(count: usize) -> &'static str {
    if count == 1 { "differs" } else { "differ" }
}

/// Generates the chosen variants in parallel and returns them in the order of `chosen`.
fn build_all(
    family: &Family,
    chosen: &[usize],
    options: &Options<'_>,
) -> Result<Vec<BuiltVariant>> {
    let _note = (!chosen.is_empty())
        .then(|| Note::new(format!("generating {}", count(chosen.len(), "variant"))));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = threads.min(MAX_THREADS).min(chosen.len());
    let next = AtomicUsize::new(0);
    let results: Vec<Mutex<Option<Result<BuiltVariant>>>> =
        chosen.iter().map(|_| Mutex::new(None)).collect();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let job = next.fetch_add(1, Ordering::Relaxed);
                    let Some(index) = chosen.get(job) else { return };
                    let found = build(family, &family.variants[*index], options);
                    if let Ok(mut result) = results[job].lock() {
                        *result = Some(found);
                    }
                }
            });
        }
    });
    let mut built = Vec::with_capacity(chosen.len());
    let mut failed = Vec::new();
    let mut warnings = BTreeSet::new();
    for (index, result) in chosen.iter().zip(results) {
        let variant = &family.variants[*index];
        let interrupted = || Error::input("the work on a variant was interrupted");
        match result.into_inner().ok().flatten().ok_or_else(interrupted) {
            Ok(Ok(variant)) => {
                warnings.extend(variant.warnings.clone());
                built.push(variant);
            }
            Ok(Err(error)) | Err(error) => failed.push((variant, error)),
        }
    }
    for warning in warnings {
        warn(&warning);
    }
    if failed.is_empty() {
        return Ok(built);
    }
    let mut names = Vec::new();
    for (Variant { name, line, .. }, error) in &failed {
        warn(&format!(
            "in variant `{name}` ({}:{line}):",
            family.path.display()
        ));
        error.report();
        names.push(format!("`{name}`"));
    }
    Err(Error::input(format!(
        "{} of {} cannot be generated: {}; nothing was written",
        failed.len(),
        count(family.variants.len(), "variant"),
        names.join(", ")
    )))
}

fn print(
    family: &Family,
    manifest: &Manifest,
    findings: &[Findings],
    different: &BTreeSet<String>,
    is_written: bool,
    options: &Options<'_>,
) -> Result {
    if !options.json {
        let text = table(family, manifest, findings, is_written);
        let verb = if is_written {
            "written"
        } else {
            differ(different.len())
        };
        let files = count(manifest.file_count(), "file");
        return print_text(&format!("{text}{files}, {} {verb}\n", different.len()));
    }
    let variants = family.variants.iter().zip(findings);
    let variants = variants.map(|(variant, found)| {
        json!({
            "name": variant.name,
            "findings": found.to_json(),
            "operations": manifest.operations(&variant.name),
            "verdict": manifest.verdict(&variant.name),
        })
    });
    print_json(&json!({
        "schema": SCHEMA,
        "family": family.name,
        "files": manifest.file_count(),
        "different": different,
        "written": is_written,
        "variants": variants.collect::<Vec<_>>(),
    }))
}
