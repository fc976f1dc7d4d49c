//! Tests of `eomgen page`: results of the WebAssembly module, pages in a browser, rejected options, the interactive
//! report of `discover`, and the legibility of all pages.

pub(super) mod bits;
mod browser;
mod command;
mod drawing;
mod exported;
mod hostile;
mod inputs;
mod legible;
mod motion;
mod report;
mod sampled;

use std::path::{Path, PathBuf};

use eomgen_tests::models::project;
use eomgen_tests::program::run_accepted;

fn write_page(spec: &Path, options: &[&str], folder: &Path) -> PathBuf {
    let out = folder.join("page.html");
    let (spec, place) = (spec.display().to_string(), out.display().to_string());
    let said = run_accepted(&[&["page", &spec, "--out", &place], options].concat());
    assert_eq!(said, format!("{place}: open it in a browser\n"));
    out
}

fn drawn_example(name: &str) -> PathBuf {
    project()
        .join("examples/drawn")
        .join(format!("{name}.toml"))
}
