//! `eomgen generate`: the emitted source of a variant, its certificate and a benchmark.

use std::path::Path;

use eomgen_codegen::variant::Variant;
use eomgen_validate::certificate::Certificate;
use eomgen_validate::instructions::InstructionBounds;
use eomgen_validate::model_certificate::{Sources, certify_sources};
use serde_json::json;

use crate::arguments::{Extra, Generate, Packaging};
use crate::bench_files;
use crate::certification::document;
use crate::document::SCHEMA;
use crate::emission;
use crate::emitted_files::{CERTIFICATE, check_names};
use crate::error::{Error, Result, print_json, print_text, warn};
use crate::family;
use crate::model::{load, note_redundancy, orders};
use crate::output::write_file;
use crate::settings::with_settings;
use crate::test_vectors;
use crate::trace_file::{self, TRACE};

const CHECK_WITHOUT_ALL: &str = "`--check` is available only with `--all`: `generate --all --check` compares the \
                                 checked-in variants. Nothing was written\n\nTo compare the files of other models, \
                                 list them in a family file and run `eomgen family FAMILY.toml --out DIR --check`";

pub fn run(options: &Generate) -> Result {
    // clap ignores `requires` if the required option conflicts with a given one.
    if options.check && !options.all {
        return Err(Error::input(CHECK_WITHOUT_ALL));
    }
    match (&options.spec, &options.out) {
        (Some(spec), Some(out)) => generate(options, spec, out),
        _ => checked_in_variants(options.check, options.output.json),
    }
}

/// Folder of the variants in the repository.
const CHECKED_IN: &str = "generated/src/variants";

/// Family file of these variants.
const CHECKED_IN_FAMILY: &str = "generated/family.toml";

/// Runs `family` on all variants of the repository. Unchanged variants are generated too, because the generator can
/// change within one version.
fn checked_in_variants(check: bool, json: bool) -> Result {
    let current = std::env::current_dir()
        .map_err(|error| Error::input(format!("no current folder: {error}")))?;
    let mut folders = current.ancestors();
    let root = folders.find(|folder| folder.join(CHECKED_IN_FAMILY).is_file());
    let root = root.ok_or_else(|| {
        Error::input(format!(
            "--all needs the project's folder: neither the current folder nor one above contains {CHECKED_IN_FAMILY}"
        ))
    })?;
    family::run(&family::Options {
        file: &root.join(CHECKED_IN_FAMILY),
        out: &root.join(CHECKED_IN),
        check,
        force: true,
        json,
    })
}

fn generate(options: &Generate, spec: &Path, out: &Path) -> Result {
    let outputs = emission::outputs(options.target, &options.with, options.certify)?;
    if options.with.contains(&Extra::Bench) && options.packaging == Some(Packaging::Module) {
        return Err(Error::input(
            "--with bench needs --packaging crate: the benchmark is a crate",
        ));
    }
    let model = with_settings(load(spec)?.model, &options.parameters.set)?;
    let orders = orders(&model, options.order.text())?;
    let variant =
        Variant::derive_with_trace(&model, &orders, &outputs).map_err(Error::Specification)?;
    note_redundancy(&variant.equations.redundancy.describe(&model));
    let form = (options.target, options.packaging);
    let mut emitted = emission::files(&model, &variant, form)?;
    let name = &variant.program.name;
    let sources = emission::sources(name, options.target, &emitted, &outputs)?;
    emitted.extend(test_vectors::files(
        &model,
        &orders,
        &variant.program,
        &options.with,
        options.target,
    )?);
    if options.with.contains(&Extra::Trace) {
        let sources = emitted.iter().map(|(name, text)| (&**name, &**text));
        let trace = trace_file::document(&variant.program, sources)?;
        emitted.push((TRACE.to_owned(), trace.into_bytes()));
    }
    let contents = emitted.iter().map(|(name, text)| (&**name, &**text));
    check_names(contents.chain(options.certify.then_some((CERTIFICATE, &[][..]))))?;
    let mut certificate = None;
    if options.certify {
        let instructions = instruction_bounds(&sources, &options.instructions)?;
        // The check of the functions for CasADi derives their outputs itself, so only the common outputs are derived
        // for the other checks.
        let shared = match sources.casadi {
            Some(_) => &[][..],
            None => &outputs,
        };
        certificate = Some(Certificate {
            instructions,
            ..certify_sources(&model, &orders, shared, &sources)?
        });
    }
    let mut files = Vec::new();
    for (name, contents) in &emitted {
        files.push(out.join(name));
        write_file(&out.join(name), contents)?;
    }
    let first = &emitted[0].1;
    if options.with.contains(&Extra::Bench) {
        files.extend(bench_files::write(&model, &variant, &outputs, out)?);
    }
    if let Some(certificate) = &certificate {
        let path = out.join(CERTIFICATE);
        write_file(&path, document(certificate)?.as_bytes())?;
        files.push(path);
    }
    let files: Vec<String> = files
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    if options.output.json {
        let document = json!({
            "schema": SCHEMA,
            "model": variant.program.name,
            "orders": variant.equations.graph.orders(),
            "file": files[0],
            "files": files,
            "bytes": first.len(),
            "certified": certificate.as_ref().map(|certificate| certificate.passed),
        });
        print_json(&document)?;
    } else {
        let size = emission::size(options.target, first);
        print_text(&format!("{}: {size}\n", files[0]))?;
        for file in &files[1..] {
            print_text(&format!("{file}\n"))?;
        }
    }
    certificate.as_ref().map_or(Ok(()), require_passed)
}

/// Bounds the instructions and the stack of the functions of emitted C for each compiler.
///
/// # Errors
/// A target other than C, or a compiler that cannot compile the source.
fn instruction_bounds(sources: &Sources, commands: &[String]) -> Result<Vec<InstructionBounds>> {
    if !commands.is_empty() && sources.c.is_empty() {
        return Err(Error::input(
            "--instructions needs --target c99: it compiles the emitted C",
        ));
    }
    let mut bounds = Vec::new();
    for command in commands {
        for source in &sources.c {
            let bounded = emission::instructions(source, command);
            bounds.push(bounded.map_err(|message| {
                Error::input(format!("--instructions {command:?}: {message}"))
            })?);
        }
    }
    Ok(bounds)
}

/// Fails with exit status 1 if a check failed or was not run.
fn require_passed(certificate: &Certificate) -> Result {
    if certificate.passed {
        return Ok(());
    }
    let failed: Vec<&str> = certificate.failures().map(|check| &*check.name).collect();
    let found = match failed.as_slice() {
        [] => "the certificate is partial: some checks were not run".to_owned(),
        names => format!("the certificate has failed checks: {}", names.join(", ")),
    };
    warn(&format!("error: {found}; `eomgen validate` shows them"));
    Err(Error::Failed)
}
