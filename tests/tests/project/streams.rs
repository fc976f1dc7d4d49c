//! Tests of the output streams: one JSON document on stdout with `--json`, messages on stderr, and closed or full
//! streams.

use std::fs::File;
use std::process::{Command, Stdio};

use eomgen_tests::models::{path, project};
use eomgen_tests::program::{self, eomgen, run, text};
use serde_json::Value;

fn spec(name: &str) -> String {
    path(name).display().to_string()
}

fn document(arguments: &[&str], status: i32) -> Value {
    let mut command = eomgen();
    let output = command
        .args(arguments)
        .arg("--json")
        .current_dir(project())
        .output();
    let output = output.expect("the program can be run");
    let shown = arguments.join(" ");
    assert_eq!(
        output.status.code(),
        Some(status),
        "{shown}: {}",
        text(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{shown}: {error}"))
}

#[test]
fn json_option_prints_one_document_for_every_command() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out").display().to_string();
    let table = folder.path().join("a.csv").display().to_string();
    let (arm, emps) = (spec("planetary_arm"), spec("emps"));
    let checked = document(&["check", &arm, "--order", "2"], 0);
    assert_eq!(checked["state"].as_array().map(Vec::len), Some(10));
    assert_eq!(document(&["derive", &arm], 0)["schema"], 2);
    assert_eq!(
        document(&["generate", &arm, "--out", &out], 0)["orders"],
        serde_json::json!([4])
    );
    assert!(document(&["generate", "--all", "--check"], 0)["files"].is_u64());
    let certificate = document(&["validate", &emps], 0);
    assert_eq!(certificate["schema"], 2);
    assert_eq!(certificate["passed"], true);
    for key in ["name", "value", "tolerance", "passed", "skipped"] {
        assert!(
            certificate["checks"][0].get(key).is_some(),
            "{key}: {certificate}"
        );
    }
    // The warning about the undriven force is printed to stderr.
    let simulated = document(&["simulate", &emps, "--until", "1", "--out", &table], 0);
    assert_eq!(simulated["rows"], 1001);
    for name in ["matrices.json", "matrices.npz"] {
        let matrices = folder.path().join(name).display().to_string();
        let linearised = document(&["linearise", &emps, "--out", &matrices], 0);
        assert_eq!(linearised["states"], 2, "{name}");
    }
}

#[test]
fn commands_that_derive_note_dependent_constraints() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let rods = project().join("tests/features/redundant_rods.toml");
    let rods = rods.display().to_string();
    for command in [
        &["check"][..],
        &["derive"],
        &["generate", "--out", &out],
        &["generate", "--target", "c99", "--out", &out],
        &["simulate", "--until", "0.01", "--out", "-"],
        &["modes"],
    ] {
        let found = run(&[&[command[0], &rods], &command[1..]].concat());
        let said = text(&found.stderr);
        assert!(said.contains("is redundant"), "{command:?}: {said}");
    }
}

#[test]
fn errors_of_a_specification_are_printed_as_json() {
    let folder = tempfile::tempdir().expect("a folder");
    let broken = folder.path().join("broken.toml");
    let text = std::fs::read_to_string(path("pendulum")).expect("the pendulum");
    std::fs::write(&broken, text.replace("m*g*height", "m*g*hight")).expect("a file");
    let found = document(&["check", &broken.display().to_string()], 2);
    assert_eq!(found["passed"], false);
    let message = found["diagnostics"][0].to_string();
    assert!(message.contains("hight"), "{found}");
    let found = document(&["check", &spec("pendulum"), "--order", "3"], 2);
    assert_eq!(found["passed"], false);
    assert!(
        found["diagnostics"][0].to_string().contains("no field"),
        "{found}"
    );
}

#[test]
fn stderr_is_empty_on_success() {
    for arguments in [["check", "pendulum"], ["derive", "furuta_pendulum"]] {
        let output = run(&[arguments[0], &spec(arguments[1])]);
        assert_eq!(output.status.code(), Some(0));
        assert_eq!(text(&output.stderr), "");
    }
}

#[test]
fn closed_pipe_is_not_an_error() {
    let mut child = Command::new(program::path())
        .args(["derive", &spec("planetary_arm"), "--order", "128", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program can be run");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("an end");
    assert_eq!(text(&output.stderr), "");
    assert_eq!(output.status.code(), Some(0));
}

#[cfg(target_os = "linux")]
#[test]
fn full_device_is_an_error_for_stdout_only() {
    let full = || {
        File::options()
            .write(true)
            .open("/dev/full")
            .expect("the full device")
    };
    let mut command = Command::new(program::path());
    let output = command
        .args(["derive", &spec("pendulum")])
        .stdout(full())
        .output();
    let output = output.expect("the program can be run");
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("cannot write to stdout"));

    // Stderr is full as well, so that warning and error cannot be written.
    let folder = tempfile::tempdir().expect("a folder");
    let simulate = |until: &str| {
        let mut command = Command::new(program::path());
        command.args(["simulate", &spec("emps"), "--until", until, "--out"]);
        command
            .arg(folder.path().join("a.csv"))
            .stdout(Stdio::null())
            .stderr(full());
        command.status().expect("the program can be run").code()
    };
    assert_eq!(simulate("1"), Some(0));
    assert_eq!(simulate("0"), Some(2));
}
