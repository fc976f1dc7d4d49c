//! `eomgen generate`: emitted source, of one variant or of all that are checked in.

use std::path::{Path, PathBuf};

use codegen::program::Program;
use codegen::rust::{Packaging, emit};
use serde_json::json;

use crate::arguments::{Generate, Target};
use crate::output::write_file;
use crate::problem::{Outcome, Problem, say, warn};
use crate::variant::{derive_variant, load, orders};

/// The specification whose variants are checked in.
const SPECIFICATION: &str = "model-spec/models/planetary_arm.toml";

/// Where they are checked in.
const FOLDER: &str = "generated/src";

/// The highest order checked in.
const HIGHEST_ORDER: usize = 8;

/// Runs the command.
pub fn run(options: &Generate) -> Outcome {
    match (&options.spec, &options.out) {
        (Some(spec), Some(out)) => one(options, spec, out),
        _ => all(options.check, options.json),
    }
}

fn one(options: &Generate, spec: &Path, out: &Path) -> Outcome {
    let Target::Rust = options.target;
    let checked = load(spec)?;
    let orders = orders(&checked.model, options.order.as_deref())?;
    let variant = codegen::variant::Variant::derive_with(&checked.model, &orders, &options.with)
        .map_err(Problem::Specification)?;
    let text = source(&variant.program, Packaging::Crate)?;
    let path = out.join("lib.rs");
    write_file(&path, text.as_bytes())?;
    if options.json {
        let document = json!({
            "model": variant.program.name,
            "orders": variant.equations.graph.orders(),
            "file": path.display().to_string(),
            "bytes": text.len(),
        });
        return say(&format!("{document:#}\n"));
    }
    say(&format!(
        "{}: {} lines\n",
        path.display(),
        text.lines().count()
    ))
}

/// The emitted source of a program.
pub fn source(program: &Program, packaging: Packaging) -> Outcome<String> {
    emit(program, packaging).map_err(|error| Problem::input(error.to_string()))
}

fn all(check: bool, json: bool) -> Outcome {
    let root = project_root()?;
    let files = checked_in_files(&root)?;
    let mut different = Vec::new();
    for (name, text) in &files {
        let path = root.join(FOLDER).join(name);
        let present = std::fs::read_to_string(&path).unwrap_or_default();
        if present != *text {
            different.push(name.clone());
            if !check {
                write_file(&path, text.as_bytes())?;
            }
        }
    }
    if json {
        let document = json!({"files": files.len(), "different": different, "written": !check});
        say(&format!("{document:#}\n"))?;
    } else {
        let verb = if check { "differ" } else { "written" };
        say(&format!(
            "{} files, {} {verb}\n",
            files.len(),
            different.len()
        ))?;
    }
    if check && !different.is_empty() {
        warn(&format!(
            "error: not what the generator emits: {}; run `eomgen generate --all`",
            different.join(", ")
        ));
        return Err(Problem::Failed);
    }
    Ok(())
}

/// File names and texts of the crate `generated`.
fn checked_in_files(root: &Path) -> Outcome<Vec<(String, String)>> {
    let model = load(&root.join(SPECIFICATION))?.model;
    let mut files = Vec::new();
    let mut modules = String::new();
    for order in 0..=HIGHEST_ORDER {
        let name = match order {
            0 => format!("{}_rigid", model.name),
            order => format!("{}_order_{order}", model.name),
        };
        let variant = derive_variant(model.clone(), &vec![order; model.fields.len()])?;
        files.push((
            format!("{name}.rs"),
            source(&variant.program, Packaging::Module)?,
        ));
        modules.push_str(&format!("#[rustfmt::skip]\npub mod {name};\n"));
    }
    let header = "//! Equations of motion of the planetary arm, rigid and with one to eight modes, as\n\
                  //! emitted by `eomgen generate --all`. Do not edit: regenerate.\n\n\
                  #![no_std]\n\n";
    files.push(("lib.rs".to_owned(), format!("{header}{modules}")));
    Ok(files)
}

/// The folder of the project, at or above the current one.
fn project_root() -> Outcome<PathBuf> {
    let current = std::env::current_dir()
        .map_err(|error| Problem::input(format!("no current folder: {error}")))?;
    current
        .ancestors()
        .find(|folder| folder.join(SPECIFICATION).is_file() && folder.join(FOLDER).is_dir())
        .map(Path::to_path_buf)
        .ok_or_else(|| {
            Problem::input(format!(
                "--all works inside the project: no folder here or above holds {SPECIFICATION} and {FOLDER}"
            ))
        })
}
