//! The program on specifications that are none: exit status 2, a message with its place,
//! within a second, and nothing left behind. The messages themselves are tested where they
//! are made, beside the corpus.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use eomgen_tests::models::{path, project};
use eomgen_tests::program::{self, eomgen, text};

/// The longest a refusal may take.
const PATIENCE: Duration = Duration::from_secs(1);

/// Runs a command on `spec` that must refuse it; the message.
fn refused(command: &[&str], spec: &Path) -> String {
    program::path();
    let begun = Instant::now();
    let output = eomgen()
        .args(command)
        .arg(spec)
        .output()
        .expect("the program can be run");
    let taken = begun.elapsed();
    let message = text(&output.stderr);
    let shown = format!("{} {}", command.join(" "), spec.display());
    assert_eq!(output.status.code(), Some(2), "{shown}: {message}");
    assert!(taken < PATIENCE, "{shown}: took {taken:?}");
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

/// `spec` is refused by `check` and by `generate`, which leaves no folder; the message.
fn leaves_nothing(spec: &Path) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    refused(
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
    assert!(left.is_empty(), "{}: left {left:?}", spec.display());
    refused(&["check"], spec)
}

/// The `:line:column` that a message points at.
fn place(message: &str) -> Option<&str> {
    let (_, rest) = message.split_once("--> ")?;
    let line = rest.lines().next()?;
    let (_, place) = line.split_once(".toml")?;
    Some(place).filter(|place| place.split(':').skip(1).all(|n| n.parse::<usize>().is_ok()))
}

#[test]
fn every_file_of_the_corpus_is_refused_at_its_place() {
    let folder = project().join("model-spec/tests/corpus/broken");
    let entries = std::fs::read_dir(folder).expect("the corpus");
    let mut specs: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    specs.retain(|spec| spec.extension().is_some_and(|ending| ending == "toml"));
    assert!(specs.len() >= 20, "only {} files", specs.len());
    for spec in specs {
        let message = leaves_nothing(&spec);
        let golden = std::fs::read_to_string(spec.with_extension("txt")).expect("its message");
        assert_eq!(place(&message), place(&golden), "{message}");
        assert!(
            place(&golden).is_some_and(|place| !place.is_empty()),
            "no place: {golden}"
        );
    }
}

/// Writes a specification and has it refused; the message.
fn written(name: &str, contents: &[u8]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join(format!("{name}.toml"));
    std::fs::write(&spec, contents).expect("the file can be written");
    leaves_nothing(&spec)
}

/// The pendulum with one line changed.
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
fn files_that_are_too_large_are_not_read() {
    let mut large = std::fs::read(path("pendulum")).expect("the pendulum");
    large.resize(10 << 20, b'#');
    assert!(written("large", &large).contains("too large"));
}

#[test]
fn deep_nesting_is_refused() {
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
        let message = written("nested", &term(&expression));
        assert!(place(&message).is_some(), "{message}");
    }
    written(
        "arrays",
        format!("model = {}{}", "[".repeat(10_000), "]".repeat(10_000)).as_bytes(),
    );
    written("tables", format!("[{}a]", "a.".repeat(10_000)).as_bytes());
}

#[test]
fn what_is_no_text_or_no_file_is_refused() {
    assert!(written("empty", b"").contains(":1:1"));
    assert!(written("latin", b"[model]\nname = \"\xe9\"\n").contains(":2:9"));
    written("zeros", &[0; 100]);
    written("mark", b"\xef\xbb\xbf");
    let folder = tempfile::tempdir().expect("a folder");
    assert!(leaves_nothing(folder.path()).contains("not a file"));
    assert!(leaves_nothing(&folder.path().join("missing.toml")).contains("cannot be read"));
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_and_not_waited_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("pipe.toml");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("mkfifo can be run").success());
    assert!(refused(&["check"], &pipe).contains("not a file"));
}

#[test]
fn numbers_that_are_none_are_refused_at_their_place() {
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
        let message = written("number", pendulum("0.14758", value).as_bytes());
        assert!(message.contains(":16:"), "{value}: {message}");
    }
}

#[test]
fn a_name_that_would_be_code_is_refused() {
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
        let message = written("name", text.as_bytes());
        assert!(message.contains(":17:"), "{name}: {message}");
    }
}
