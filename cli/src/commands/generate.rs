//! `eomgen generate`: emitted source of one variant, with its certificate or a benchmark
//! beside it.

use std::path::{Path, PathBuf};

use eomgen_codegen::program::Output;

use eomgen_codegen::c;
use eomgen_codegen::rust::Packaging;
use eomgen_codegen::variant::Variant;
use eomgen_validate::certificate::Certificate;
use serde_json::json;

use crate::arguments::{Extra, Generate, Target};
use crate::bench_files;
use crate::certification::{certify_source, document};
use crate::checked_in;
use crate::emission::source;
use crate::error::{Error, Result, say, warn};
use crate::model::{load, orders};
use crate::output::write_file;

/// Runs the command.
pub fn run(options: &Generate) -> Result {
    match (&options.spec, &options.out) {
        (Some(spec), Some(out)) => one(options, spec, out),
        _ => checked_in::run(options.check, options.json),
    }
}

fn one(options: &Generate, spec: &Path, out: &Path) -> Result {
    if options.target == Target::C99 {
        return in_c(options, spec, out);
    }
    let model = load(spec)?.model;
    let orders = orders(&model, options.order.as_deref())?;
    let outputs = Extra::outputs(&options.with);
    let variant = Variant::derive_with(&model, &orders, &outputs).map_err(Error::Specification)?;
    let text = source(&variant.program, Packaging::Crate)?;
    let certificate = match options.certify {
        true => Some(certify_source(&model, &orders, &outputs, text.clone())?),
        false => None,
    };
    let path = out.join("lib.rs");
    write_file(&path, text.as_bytes())?;
    let mut files = vec![path];
    if options.with.contains(&Extra::Bench) {
        files.extend(bench_files::leave(&model, &variant, &outputs, out)?);
    }
    if let Some(certificate) = &certificate {
        let path = out.join("certificate.json");
        write_file(&path, document(certificate)?.as_bytes())?;
        files.push(path);
    }
    summarise(options, &variant, &text, &files, certificate.as_ref())?;
    certificate.as_ref().map_or(Ok(()), passed)
}

/// The header and the source in C.
fn in_c(options: &Generate, spec: &Path, out: &Path) -> Result {
    refuse_of_rust(options)?;
    let model = load(spec)?.model;
    let orders = orders(&model, options.order.as_deref())?;
    let outputs = Extra::outputs(&options.with);
    let variant = Variant::derive_with(&model, &orders, &outputs).map_err(Error::Specification)?;
    let emitted = c::emit(&variant.program).map_err(|error| Error::input(error.to_string()))?;
    let named = |end: &str| out.join(format!("{}.{end}", variant.program.name));
    let files = vec![named("c"), named("h")];
    write_file(&files[1], emitted.header.as_bytes())?;
    write_file(&files[0], emitted.source.as_bytes())?;
    summarise(options, &variant, &emitted.source, &files, None)
}

/// What goes with emitted Rust alone.
fn refuse_of_rust(options: &Generate) -> Result {
    let reason = if options.certify {
        "--certify goes with --target rust: a certificate is of the emitted Rust, whose bits the C \
         gives as well"
    } else if options.with.contains(&Extra::Bench) {
        "--with bench goes with --target rust: the benchmark is a crate"
    } else if options.with.contains(&Extra::Output(Output::Lanes)) {
        "--with lanes goes with --target rust: its functions are generic in the type of numbers, \
         which C has no way to say"
    } else {
        return Ok(());
    };
    Err(Error::input(reason))
}

/// Says what was written: `text` is what stands in the first file.
fn summarise(
    options: &Generate,
    variant: &Variant,
    text: &str,
    files: &[PathBuf],
    certificate: Option<&Certificate>,
) -> Result {
    let files: Vec<String> = files
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    if options.json {
        let document = json!({
            "model": variant.program.name,
            "orders": variant.equations.graph.orders(),
            "file": files[0],
            "files": files,
            "bytes": text.len(),
            "certified": certificate.map(|certificate| certificate.passed),
        });
        return say(&format!("{document:#}\n"));
    }
    say(&format!("{}: {} lines\n", files[0], text.lines().count()))?;
    for file in &files[1..] {
        say(&format!("{file}\n"))?;
    }
    Ok(())
}

/// An end with exit status 1 if any check failed.
fn passed(certificate: &Certificate) -> Result {
    if certificate.passed {
        return Ok(());
    }
    let failed: Vec<&str> = certificate.failures().map(|check| &*check.name).collect();
    let names = failed.join(", ");
    warn(&format!(
        "error: the certificate has failed checks: {names}; `eomgen validate` shows them"
    ));
    Err(Error::Failed)
}
