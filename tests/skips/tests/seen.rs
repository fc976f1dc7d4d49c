//! Tests that skips of passing tests are visible and that all tests report skips by `skips::skip`.

use std::path::{Path, PathBuf};
use std::process::Command;

use skips::{LIST, skip};

#[test]
#[ignore = "run by the test below"]
fn skips() {
    skip("nothing was tested: everything is missing");
}

#[test]
fn skip_of_passing_test_is_printed_and_listed() {
    let folder = tempfile::tempdir().expect("a folder");
    let list = folder.path().join("skips");
    for lines in 1..=2 {
        let output = Command::new(std::env::current_exe().expect("this test"))
            .args(["--exact", "skips", "--ignored"])
            .env(LIST, &list)
            .output()
            .expect("this test can be run");
        assert!(output.status.success());
        let seen = String::from_utf8_lossy(&output.stderr).into_owned();
        let name = Path::new("tests/skips/tests/seen.rs").display();
        let line = format!("SKIPPED: {name}: nothing was tested: everything is missing\n");
        assert!(seen.contains(&line), "{seen}");
        let listed = std::fs::read_to_string(&list).expect("a list");
        assert_eq!(listed, line.repeat(lines), "each run appends a line");
    }
}

/// Collects the Rust files of tests below a folder.
fn test_files(folder: &Path, within_tests: bool, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.is_dir() && !name.starts_with("target") && !name.starts_with('.') {
            test_files(&path, within_tests || name == "tests", found);
        } else if within_tests && name.ends_with(".rs") {
            found.push(path);
        }
    }
}

#[test]
fn all_tests_report_skips_by_skip() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut files = Vec::new();
    test_files(&project, false, &mut files);
    assert!(files.len() > 100, "the project's tests: {}", files.len());
    let own = ["tests/skips/src/lib.rs", "tests/skips/tests/seen.rs"];
    for file in files
        .iter()
        .filter(|file| !own.iter().any(|own| file.ends_with(own)))
    {
        let text = std::fs::read_to_string(file).expect("a file");
        // The word is split, so that this file itself does not match.
        let found = text.contains(concat!("\"SKIP", "PED"));
        assert!(!found, "{}: report skips by skips::skip", file.display());
    }
}
