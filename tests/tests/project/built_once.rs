//! The program and the Python package have their dependencies with the features that the tests and
//! benches ask of them: `cargo run`, `cargo test --workspace` and `pip install ./python`, one after
//! the other as in `.ci/run`, then compile nothing twice.

use std::collections::BTreeSet;
use std::process::Command;

use eomgen_tests::models::project;

/// Packages with their features, of what is chosen and all that it needs.
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

/// The program and the Python package.
const PROGRAMS: [&str; 2] = ["eomgen-cli", "eomgen-python"];

/// Compares what each needs alone, along these edges, with what is built for the tests.
fn compare(edges: &str, whole: &BTreeSet<String>) {
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
fn what_the_program_needs_is_built_as_the_tests_need_it() {
    // What is built for the compiler itself, with features of its own, stays out.
    let hosts = ["--exclude", "eomgen-macros", "--exclude", "eomgen-build"];
    let whole = ["--workspace", "--edges", "normal,dev,no-proc-macro"];
    let whole = packages(&[&whole[..], &hosts].concat());
    compare("normal,no-proc-macro", &whole);
}

#[test]
fn macros_that_it_is_compiled_with_are_those_of_the_tests() {
    let whole = packages(&["--workspace", "--edges", "normal,build,dev"]);
    compare("normal,build", &whole);
}
