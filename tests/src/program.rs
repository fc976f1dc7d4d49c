//! Runs the `eomgen` program, built like the tests, with a time limit.

use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::OnceLock;
use std::time::Duration;

use serde_json::Value;

use crate::models::project;

const LIMIT: Duration = Duration::from_secs(60);

/// Builds the program once and returns its path.
pub fn path() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(build)
}

/// Returns the target folder and the profile of the running test.
pub fn target() -> (PathBuf, String) {
    let test = std::env::current_exe().expect("the running test has a path");
    let profile = test.ancestors().nth(2).expect("target/PROFILE/deps/TEST");
    let target = profile.parent().expect("target/PROFILE");
    let name = profile.file_name().expect("a profile").to_string_lossy();
    let profile = if name == "debug" { "dev" } else { &*name };
    (target.to_owned(), profile.to_owned())
}

/// Returns the newest compiled library of a crate in the target folder of the running test.
pub fn compiled_library(name: &str) -> PathBuf {
    let test = std::env::current_exe().expect("the running test has a path");
    let folder = test.parent().expect("target/PROFILE/deps");
    let start = format!("lib{name}-");
    let is_library = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(&start) && name.ends_with(".rlib")
    };
    let files = std::fs::read_dir(folder).expect("a folder").flatten();
    let libraries = files.map(|file| file.path()).filter(is_library);
    let newest = libraries.max_by_key(|path| {
        let file = path.metadata().expect("a library");
        file.modified().expect("a time")
    });
    newest.unwrap_or_else(|| panic!("{name} is not in {}", folder.display()))
}

/// Returns a `cargo` command in the project's folder that builds like the tests.
pub fn cargo() -> std::process::Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = std::process::Command::new(cargo);
    command.current_dir(project());
    command
}

fn build() -> PathBuf {
    let (target, profile) = target();
    let status = cargo()
        .args(["build", "--quiet", "--package", "eomgen-cli"])
        .args(["--profile", &profile, "--target-dir"])
        .arg(&target)
        .status()
        .expect("cargo can be run");
    assert!(status.success(), "the program does not build");
    let folder = if profile == "dev" { "debug" } else { &profile };
    let name = format!("eomgen{}", std::env::consts::EXE_SUFFIX);
    target.join(folder).join(name)
}

/// Returns a command that runs the program.
pub fn eomgen() -> assert_cmd::Command {
    let mut command = assert_cmd::Command::new(path());
    command.timeout(LIMIT);
    command
}

/// Runs the program.
pub fn run(arguments: &[&str]) -> Output {
    eomgen()
        .args(arguments)
        .output()
        .expect("the program can be run")
}

/// Runs the program, asserts exit status 2 and returns its message.
pub fn run_rejected(arguments: &[&str]) -> String {
    let output = run(arguments);
    let message = text(&output.stderr);
    let shown = arguments.join(" ");
    assert_eq!(output.status.code(), Some(2), "{shown}: {message}");
    assert!(message.contains("error"), "{shown}: {message}");
    assert!(!message.contains("error: error"), "{shown}: {message}");
    assert!(!message.contains("panicked"), "{shown}: {message}");
    message
}

/// Runs the program, asserts success and returns its stdout.
pub fn run_accepted(arguments: &[&str]) -> String {
    let output = run(arguments);
    let shown = arguments.join(" ");
    assert_eq!(
        output.status.code(),
        Some(0),
        "{shown}: {}",
        text(&output.stderr)
    );
    text(&output.stdout)
}

/// Runs `compare` or `discover` on a specification and a dataset with output to a folder; asserts
/// success and returns the document.
pub fn run_on_dataset(command: &str, paths: [&PathBuf; 3]) -> Value {
    let [specification, dataset, out] = paths.map(|path| path.display().to_string());
    run_accepted(&[command, &specification, &dataset, "--out", &out]);
    let name = match command {
        "compare" => "comparison.json",
        _ => "discovery.json",
    };
    let document = std::fs::read_to_string(paths[2].join(name)).expect("a document");
    serde_json::from_str(&document).expect("JSON")
}

/// Writes the texts to a temporary folder and runs [`run_on_dataset`].
pub fn run_on_texts(command: &str, texts: Texts<'_>) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    for (name, text) in [
        ("spec.toml", texts.specification),
        ("dataset.toml", texts.dataset),
        ("train.csv", texts.train),
        ("test.csv", texts.test),
    ] {
        std::fs::write(place(name), text).expect("a file");
    }
    let paths = ["spec.toml", "dataset.toml", "found"].map(place);
    run_on_dataset(command, paths.each_ref())
}

/// Input files of `compare` or `discover`; the dataset names the records `train.csv` and
/// `test.csv`.
pub struct Texts<'t> {
    /// Specification.
    pub specification: &'t str,
    /// Dataset file.
    pub dataset: &'t str,
    /// Training record.
    pub train: &'t str,
    /// Held-out record.
    pub test: &'t str,
}

/// Converts bytes to text.
pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
