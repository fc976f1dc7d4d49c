//! The program is installed as README.md says, and can do what it is installed for.

use std::process::Command;

use eomgen_tests::models::path;
use eomgen_tests::program::{cargo, target, text};

#[test]
fn an_installed_program_says_its_version_and_checks_a_specification() {
    let root = tempfile::tempdir().expect("a folder");
    let (target, profile) = target();
    // As printed, but for where to: not among this machine's programs, and from what is built.
    let output = cargo()
        .args(["install", "--path", "cli", "--offline", "--locked"])
        .args(["--profile", &profile, "--no-track", "--target-dir"])
        .arg(target)
        .arg("--root")
        .arg(root.path())
        .output()
        .expect("cargo can be run");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let name = format!("eomgen{}", std::env::consts::EXE_SUFFIX);
    let program = root.path().join("bin").join(name);
    let run = |arguments: &[&str]| {
        let output = Command::new(&program).args(arguments).output();
        let output = output.expect("the program can be run");
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        text(&output.stdout)
    };
    let version = concat!("eomgen ", env!("CARGO_PKG_VERSION"), "\n");
    assert_eq!(run(&["--version"]), version);
    let specification = path("pendulum").display().to_string();
    assert!(run(&["check", &specification]).contains("names and units agree"));
}
