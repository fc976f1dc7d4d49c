//! Test that the program, the Python package and the studies build their dependencies with the same features as the
//! tests and benches. Therefore `.ci/run`, which runs `cargo run`, `cargo test --workspace` and `pip install ./python`
//! in sequence, compiles nothing twice.

use std::collections::BTreeSet;
use std::process::Command;

use eomgen_tests::models::project;

/// Returns the chosen packages and their dependencies, each with its features.
fn packages(chosen: &[&str]) -> BTreeSet<String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args(["tree", "--offline", "--locked", "--prefix", "none"])
        .args(["--format", "{p} with {f}"])
        .args(chosen)
        .current_dir(project())
        .output()
        .expect("cargo can be run");
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).expect("names");
    let line = |line: &str| line.trim_end_matches(" (*)").to_owned();
    text.lines().map(line).collect()
}

const PROGRAMS: [&str; 3] = ["eomgen-cli", "eomgen-python", "eomgen-studies"];

/// Asserts that each published package and its dependencies along these edges have the same features as in the tests.
fn assert_same_features(edges: &str, whole: &BTreeSet<String>) {
    for package in PROGRAMS {
        let alone = packages(&["--package", package, "--edges", edges]);
        let twice: Vec<_> = alone.difference(whole).collect();
        assert!(
            twice.is_empty(),
            "compiled for {package} and again for the tests; add to workspace-hack/Cargo.toml the \
             features that the tests do: {twice:#?}"
        );
    }
}

#[test]
fn dependencies_have_the_same_features_as_in_tests() {
    // Crates that run inside the compiler are built with other features, so they are excluded.
    let hosts = ["--exclude", "eomgen-macros", "--exclude", "eomgen-build"];
    let whole = ["--workspace", "--edges", "normal,dev,no-proc-macro"];
    let whole = packages(&[&whole[..], &hosts].concat());
    assert_same_features("normal,no-proc-macro", &whole);
}

#[test]
fn build_dependencies_have_the_same_features_as_in_tests() {
    let whole = packages(&["--workspace", "--edges", "normal,build,dev"]);
    assert_same_features("normal,build", &whole);
}
