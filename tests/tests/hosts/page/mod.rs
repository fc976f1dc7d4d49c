//! `eomgen page`: the module of WebAssembly that its pages compute with, bit by bit; the pages, in a
//! browser; what the command refuses; and the report of a discovery, which computes as they do.

mod bits;
mod browser;
mod command;
mod drawing;
mod hostile;
mod motion;
mod report;

use std::path::{Path, PathBuf};

use eomgen_tests::models::project;
use eomgen_tests::program::accepted;

/// The page of a specification, with further options, in this folder; where it is.
fn page(spec: &Path, options: &[&str], folder: &Path) -> PathBuf {
    let out = folder.join("page.html");
    let (spec, place) = (spec.display().to_string(), out.display().to_string());
    let said = accepted(&[&["page", &spec, "--out", &place], options].concat());
    assert_eq!(said, format!("open {place}\n"));
    out
}

/// The examples with a drawing of their own.
fn drawn(name: &str) -> PathBuf {
    project()
        .join("examples/drawn")
        .join(format!("{name}.toml"))
}
