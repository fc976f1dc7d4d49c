//! A skip is seen though the test passes.

use std::path::Path;
use std::process::Command;

use skips::{LIST, skip};

#[test]
#[ignore = "run by the test below"]
fn skips() {
    skip("nothing was looked at, for want of anything");
}

#[test]
fn a_skip_of_a_test_that_passes_is_seen_and_listed() {
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
        let line = format!("SKIPPED: {name}: nothing was looked at, for want of anything\n");
        assert!(seen.contains(&line), "{seen}");
        let listed = std::fs::read_to_string(&list).expect("a list");
        assert_eq!(listed, line.repeat(lines), "run after run is added");
    }
}
