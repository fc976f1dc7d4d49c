//! Tests of invalid specifications: the program exits with status 2 and a message with location, and leaves no files.
//! The tests of `model-spec` check the texts of the messages.

use std::path::{Path, PathBuf};

use eomgen_tests::models::{path, project};
use eomgen_tests::program::{eomgen, text};

fn reject(command: &[&str], spec: &Path) -> String {
    let output = eomgen()
        .args(command)
        .arg(spec)
        .output()
        .expect("the program can be run");
    let message = text(&output.stderr);
    let shown = format!("{} {}", command.join(" "), spec.display());
    assert_eq!(output.status.code(), Some(2), "{shown}: {message}");
    assert!(
        output.stdout.is_empty(),
        "{shown}: {}",
        text(&output.stdout)
    );
    assert!(message.starts_with("error: "), "{shown}: {message}");
    assert!(
        message.contains(&spec.display().to_string()),
        "{shown}: {message}"
    );
    message
}

/// Asserts that `check` and `generate` reject `spec` and leave no folder; returns the message.
fn reject_without_files(spec: &Path) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    reject(
        &[
            "generate",
            "--order",
            "1",
            "--out",
            &out.display().to_string(),
        ],
        spec,
    );
    let left: Vec<_> = std::fs::read_dir(folder.path())
        .expect("the folder")
        .collect();
    assert!(left.is_empty(), "{}: wrote {left:?}", spec.display());
    reject(&["check"], spec)
}

/// Returns the `:line:column` of a message.
fn read_location(message: &str) -> Option<&str> {
    let (_, rest) = message.split_once("--> ")?;
    let line = rest.lines().next()?;
    let (_, place) = line.split_once(".toml")?;
    Some(place).filter(|place| place.split(':').skip(1).all(|n| n.parse::<usize>().is_ok()))
}

#[test]
fn corpus_files_are_rejected_with_location() {
    let folder = project().join("model-spec/tests/corpus/broken");
    let entries = std::fs::read_dir(folder).expect("the corpus");
    let mut specs: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    specs.retain(|spec| spec.extension().is_some_and(|ending| ending == "toml"));
    assert!(
        specs.len() >= 20,
        "only {} files in the corpus",
        specs.len()
    );
    for spec in specs {
        let message = reject_without_files(&spec);
        let golden = std::fs::read_to_string(spec.with_extension("txt")).expect("its message");
        assert_eq!(read_location(&message), read_location(&golden), "{message}");
        assert!(
            read_location(&golden).is_some_and(|place| !place.is_empty()),
            "no place: {golden}"
        );
    }
}

/// Writes a specification and asserts its rejection; returns the message.
fn reject_text(name: &str, contents: &[u8]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join(format!("{name}.toml"));
    std::fs::write(&spec, contents).expect("the file can be written");
    reject_without_files(&spec)
}

fn pendulum(from: &str, to: &str) -> String {
    let whole = std::fs::read_to_string(path("pendulum")).expect("the pendulum");
    let changed = whole.replacen(from, to, 1);
    assert_ne!(
        whole, changed,
        "{from} is not in the pendulum's specification"
    );
    changed
}

#[test]
fn oversized_file_is_rejected() {
    let mut large = std::fs::read(path("pendulum")).expect("the pendulum");
    large.resize(10 << 20, b'#');
    assert!(reject_text("large", &large).contains("too large"));
}

#[test]
fn deep_nesting_is_rejected() {
    let term = |expression: &str| pendulum("1/2*(m*a^2 + I)*dot(theta)^2", expression).into_bytes();
    let (open, close) = ("(".repeat(10_000), ")".repeat(10_000));
    for expression in [
        format!("{open}m{close}"),
        open.clone(),
        format!("{}m", "-".repeat(10_000)),
        format!("{}m", "1^".repeat(10_000)),
        format!("{}m{close}", "sin(".repeat(10_000)),
        format!("m{}", "/m".repeat(10_000)),
    ] {
        let message = reject_text("nested", &term(&expression));
        assert!(read_location(&message).is_some(), "{message}");
    }
    reject_text(
        "arrays",
        format!("model = {}{}", "[".repeat(10_000), "]".repeat(10_000)).as_bytes(),
    );
    reject_text("tables", format!("[{}a]", "a.".repeat(10_000)).as_bytes());
}

#[test]
fn empty_binary_or_missing_file_is_rejected() {
    assert!(reject_text("empty", b"").contains(":1:1"));
    assert!(reject_text("latin", b"[model]\nname = \"\xe9\"\n").contains(":2:9"));
    reject_text("zeros", &[0; 100]);
    reject_text("mark", b"\xef\xbb\xbf");
    let folder = tempfile::tempdir().expect("a folder");
    assert!(reject_without_files(folder.path()).contains("not a file"));
    assert!(reject_without_files(&folder.path().join("missing.toml")).contains("cannot be read"));
}

#[cfg(unix)]
#[test]
fn pipe_is_rejected_without_waiting() {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("pipe.toml");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("mkfifo can be run").success());
    assert!(reject(&["check"], &pipe).contains("not a file"));
}

#[test]
fn invalid_numbers_are_rejected_with_location() {
    for value in [
        "nan",
        "inf",
        "-inf",
        "1e400",
        "-1",
        "\"1/0\"",
        "\"sqrt(-1)\"",
        "\"exp(1e9)\"",
    ] {
        let message = reject_text("number", pendulum("0.14758", value).as_bytes());
        assert!(message.contains(":16:"), "{value}: {message}");
    }
}

#[test]
fn name_that_contains_code_is_rejected() {
    for name in [
        "\"; std::process::exit(1) //\"",
        "fn",
        "\"m\\n\"",
        "'é'",
        "\"\"",
        "self",
    ] {
        let text = pendulum(
            "a = { value = 0.14775",
            &format!("{name} = {{ value = 0.14775"),
        );
        let message = reject_text("name", text.as_bytes());
        assert!(message.contains(":17:"), "{name}: {message}");
    }
}
