//! Seeded faults in emitted C and Rust: `verify` finds them by its checks, not only by the hash.

use std::path::Path;
use std::process::Command;

use eomgen_tests::models::path;
use eomgen_tests::program::eomgen;
use serde_json::Value;

/// Generates a source with Jacobians and its certificate.
fn generate(folder: &Path, target: &str) {
    let output = eomgen()
        .arg("generate")
        .arg(path("hub_beam_tip_mass"))
        .args(["--order", "1", "--with", "jacobians", "--certify"])
        .args(["--target", target, "--out"])
        .arg(folder)
        .output()
        .expect("the program can be run");
    assert!(output.status.success(), "{output:?}");
}

/// Returns the names of the failed checks of a file.
fn failed_checks(folder: &Path, file: &str) -> Vec<String> {
    let output = eomgen()
        .current_dir(folder)
        .args(["verify", file, "certificate.json", "--json"])
        .output()
        .expect("the program can be run");
    let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let checks = document["checks"].as_array().expect("checks");
    let failed = checks
        .iter()
        .filter(|check| check["passed"] == false && check["skipped"] == false);
    failed
        .map(|check| check["name"].as_str().expect("a name").to_owned())
        .collect()
}

/// Replaces the first `from` after `after`, verifies, and restores the file.
fn with_fault(folder: &Path, file: &str, [after, from, to]: [&str; 3]) -> Vec<String> {
    let path = folder.join(file);
    let text = std::fs::read_to_string(&path).expect("a file");
    let start = text.find(after).expect(after);
    let (head, rest) = text.split_at(start);
    assert!(rest.contains(from), "{from}");
    std::fs::write(&path, head.to_owned() + &rest.replacen(from, to, 1)).expect("written");
    let found = failed_checks(folder, file);
    std::fs::write(&path, text).expect("written");
    found
}

#[test]
fn faults_of_places_and_definiteness_in_c_are_found() {
    if Command::new("cc").arg("--version").output().is_err() {
        skips::skip("faults of the emitted C were not seeded: cc is missing (Debian: gcc)");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    generate(folder, "c99");
    let c = "hub_beam_tip_mass.c";
    assert_eq!(failed_checks(folder, c), [""; 0]);
    for fault in [
        ["_rates_by_state_blocks[", "{0, ", "{1, "],
        ["_observables_by_state_blocks[", "{0, ", "{1, "],
        [
            "coefficients->positive_definite = 1",
            "positive_definite = 0",
            "positive_definite = 1",
        ],
    ] {
        assert_eq!(with_fault(folder, c, fault), ["emitted_c"], "{fault:?}");
    }
    let header = folder.join("hub_beam_tip_mass.h");
    let text = std::fs::read_to_string(&header).expect("a header");
    let constant = "RATES_BY_STATE_NONZEROS ";
    std::fs::write(&header, text.replacen(constant, &format!("{constant}1"), 1)).expect("written");
    assert_eq!(failed_checks(folder, c), ["emitted_c"]);
}

#[test]
fn faults_of_definiteness_in_rust_are_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    generate(folder, "rust");
    let file = "lib.rs";
    assert_eq!(failed_checks(folder, file), [""; 0]);
    let after = "positive_definite: T::all_greater(";
    for fault in [
        [after, "T::number(0.0))", "T::number(f64::NEG_INFINITY))"],
        [
            after,
            "T::all_greater(T::number(f64::INFINITY), ",
            "(|_| true)(",
        ],
    ] {
        assert_eq!(
            with_fault(folder, file, fault),
            ["emitted_rust"],
            "{fault:?}"
        );
    }
}
