//! Test of the installation of the program as documented in README.md.

use std::process::Command;

use eomgen_tests::models::path;
use eomgen_tests::program::{cargo, target, text};

#[test]
fn installed_program_prints_version_and_checks_specification() {
    let root = tempfile::tempdir().expect("a folder");
    let (target, profile) = target();
    // The documented command is run with a temporary root and with dependencies that are already built.
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
