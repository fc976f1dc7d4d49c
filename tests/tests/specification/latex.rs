//! Test that the LaTeX output of every specification compiles, if LaTeX is installed. The tests of `codegen` check the
//! text itself.

use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_tests::models::{project, shipped_specifications};
use eomgen_tests::program::run_accepted;

fn specifications() -> Vec<PathBuf> {
    let features = project().join("tests/features");
    let entries = std::fs::read_dir(features).expect("the folder of the features");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    shipped_specifications().into_iter().chain(paths).collect()
}

/// Compiles without writing pages; returns the log's errors on failure.
fn compile_latex(folder: &Path, name: &str) -> Result<(), String> {
    let output = Command::new("pdflatex")
        .args([
            "-draftmode",
            "-interaction=nonstopmode",
            "-halt-on-error",
            name,
        ])
        .current_dir(folder)
        .output()
        .map_err(|error| error.to_string())?;
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let wrong = said
        .split_once("\n!")
        .map_or(said.as_str(), |(_, wrong)| wrong);
    Err(wrong.chars().take(600).collect())
}

#[test]
fn latex_compiles_for_every_specification() {
    if Command::new("pdflatex").arg("--version").output().is_err() {
        skips::skip(
            "LaTeX output was not compiled: pdflatex is missing (Debian: apt-get install texlive-latex-base)",
        );
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for path in specifications() {
        let document = run_accepted(&["derive", &path.display().to_string(), "--format", "latex"]);
        std::fs::write(folder.path().join("equations.tex"), document).expect("a file");
        compile_latex(folder.path(), "equations.tex")
            .unwrap_or_else(|wrong| panic!("{}: {wrong}", path.display()));
    }
}
