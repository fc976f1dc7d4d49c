//! The `eomgen` program, built as the tests are, run with a time limit.

use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::OnceLock;
use std::time::Duration;

use serde_json::Value;

use crate::models::project;

/// The longest a run may take unless a test says otherwise.
const LIMIT: Duration = Duration::from_secs(60);

/// The program's path. It is built first, so that no test judges an older one.
pub fn path() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(build)
}

/// The folder and the profile that the running test was built with.
pub fn target() -> (PathBuf, String) {
    let test = std::env::current_exe().expect("the running test has a path");
    let profile = test.ancestors().nth(2).expect("target/PROFILE/deps/TEST");
    let target = profile.parent().expect("target/PROFILE");
    let name = profile.file_name().expect("a profile").to_string_lossy();
    let profile = if name == "debug" { "dev" } else { &*name };
    (target.to_owned(), profile.to_owned())
}

/// Cargo in the project's folder, to be given arguments: a command that builds.
pub fn cargo() -> std::process::Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = std::process::Command::new(cargo);
    command.current_dir(project());
    command
}

/// Builds into the folder that the running test was built into.
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

/// The program, to be given arguments.
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

/// Runs the program, which must refuse with exit status 2; its message.
pub fn refused(arguments: &[&str]) -> String {
    let output = run(arguments);
    let message = text(&output.stderr);
    let shown = arguments.join(" ");
    assert_eq!(output.status.code(), Some(2), "{shown}: {message}");
    assert!(message.contains("error"), "{shown}: {message}");
    assert!(!message.contains("error: error"), "{shown}: {message}");
    assert!(!message.contains("panicked"), "{shown}: {message}");
    message
}

/// Runs the program, which must succeed; its standard output.
pub fn accepted(arguments: &[&str]) -> String {
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

/// What `compare` or `discover` answers to a specification and a dataset, and leaves in a folder: the
/// command must succeed.
pub fn answered(command: &str, paths: [&PathBuf; 3]) -> Value {
    let [specification, dataset, out] = paths.map(|path| path.display().to_string());
    accepted(&[command, &specification, &dataset, "--out", &out]);
    let name = match command {
        "compare" => "comparison.json",
        _ => "discovery.json",
    };
    let document = std::fs::read_to_string(paths[2].join(name)).expect("a document");
    serde_json::from_str(&document).expect("JSON")
}

/// The same to texts, in a folder of their own.
pub fn answered_to(command: &str, texts: Texts<'_>) -> Value {
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
    answered(command, paths.each_ref())
}

/// What a comparison or a discovery reads; the records are `train.csv` and `test.csv` in the dataset.
pub struct Texts<'t> {
    /// The specification.
    pub specification: &'t str,
    /// The dataset file.
    pub dataset: &'t str,
    /// The record to learn from.
    pub train: &'t str,
    /// The record held out.
    pub test: &'t str,
}

/// Bytes as text.
pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
