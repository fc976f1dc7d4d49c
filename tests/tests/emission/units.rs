//! Tests of functional mock-up units: certificate, `verify`, and seeded faults.

use std::path::Path;
use std::process::Command;

use eomgen_targets::archive::{pack, unpack};
use eomgen_tests::models::{path, project};
use eomgen_tests::program::eomgen;
use serde_json::Value;
use tempfile::TempDir;

/// Returns true if there is a C compiler; otherwise reports the skip.
fn has_compiler() -> bool {
    let found = Command::new("cc").arg("--version").output().is_ok();
    if !found {
        skips::skip("units were not loaded: cc is missing (Debian: apt-get install gcc)");
    }
    found
}

fn run(folder: &Path, arguments: &[&str], compiler: &str) -> (Option<i32>, String) {
    let mut command = eomgen();
    command.current_dir(folder).env("CC", compiler);
    let output = command.args(arguments).output();
    let output = output.expect("the program can be run");
    let said = [output.stdout, output.stderr].concat();
    (
        output.status.code(),
        String::from_utf8_lossy(&said).into_owned(),
    )
}

/// Generates a certified unit of Furuta's pendulum.
fn certified(target: &str, compiler: &str) -> (TempDir, Option<i32>, Value) {
    certify(&path("furuta_pendulum"), target, compiler)
}

fn certify(spec: &Path, target: &str, compiler: &str) -> (TempDir, Option<i32>, Value) {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = spec.to_string_lossy();
    let arguments = [
        "generate",
        &spec,
        "--target",
        target,
        "--certify",
        "--out",
        ".",
    ];
    let (status, said) = run(folder.path(), &arguments, compiler);
    let text = std::fs::read_to_string(folder.path().join("certificate.json"));
    let text = text.unwrap_or_else(|error| panic!("{error}: {said}"));
    (folder, status, serde_json::from_str(&text).expect("JSON"))
}

fn verify(folder: &Path) -> (Option<i32>, String) {
    let arguments = ["verify", "furuta_pendulum.fmu", "certificate.json"];
    run(folder, &arguments, "cc")
}

/// Replaces a text in the file `name` of the unit.
fn edit(folder: &Path, name: &str, from: &str, to: &str) {
    let unit = folder.join("furuta_pendulum.fmu");
    let mut files = unpack(&std::fs::read(&unit).expect("a unit")).expect("an archive");
    let file = files.iter_mut().find(|(known, _)| known == name);
    let (_, contents) = file.expect("a file in the unit");
    let text = String::from_utf8(contents.clone()).expect("text");
    assert!(text.contains(from), "{from} in\n{text}");
    *contents = text.replacen(from, to, 1).into_bytes();
    std::fs::write(unit, pack(files).expect("packed")).expect("written");
}

#[test]
fn certificate_covers_units() {
    if !has_compiler() {
        return;
    }
    for target in ["fmu2", "fmu3"] {
        let (folder, status, document) = certified(target, "cc");
        assert_eq!(status, Some(0), "{document:#}");
        assert_eq!(document["verdict"], "passed");
        assert_eq!(document["unit"]["sha256"], document["source_sha256"]);
        let (status, said) = verify(folder.path());
        assert_eq!(status, Some(0), "{said}");
        for check in ["The description of the FMU", "The library in the FMU"] {
            assert!(said.contains(&format!("passed   {check}")), "{said}");
        }
    }
}

#[test]
fn certificate_covers_units_with_controllers() {
    if !has_compiler() {
        return;
    }
    let spec = project().join("tests/tests/hosts/fmi/units/sampled_block.toml");
    for target in ["fmu2", "fmu3"] {
        let (_folder, status, document) = certify(&spec, target, "cc");
        assert_eq!(status, Some(0), "{document:#}");
        assert_eq!(document["verdict"], "passed");
    }
}

#[test]
fn seeded_faults_in_units_are_found() {
    if !has_compiler() {
        return;
    }
    let description = "modelDescription.xml";
    let specification = "resources/furuta_pendulum.toml";
    for (name, from, to, check) in [
        (
            description,
            "name=\"phi\"",
            "name=\"psi\"",
            "unit_description",
        ),
        (
            description,
            "valueReference=\"10\"",
            "valueReference=\"11\"",
            "unit_library",
        ),
        (
            description,
            "rad=\"1\"",
            "rad=\"1\" m=\"1\"",
            "unit_description",
        ),
        (
            description,
            "causality=\"parameter\"",
            "causality=\"local\"",
            "unit_description",
        ),
        (
            description,
            "derivative=\"1\"",
            "derivative=\"2\"",
            "unit_description",
        ),
        (specification, "value = ", "value =  ", "unit_library"),
    ] {
        let (folder, status, document) = certified("fmu3", "cc");
        assert_eq!(status, Some(0), "{document:#}");
        edit(folder.path(), name, from, to);
        let (status, said) = verify(folder.path());
        assert_eq!(status, Some(1), "{from}: {said}");
        let mut failed = said.lines().filter(|line| line.contains("FAILED"));
        assert!(failed.any(|line| line.contains(check)), "{from}: {said}");
    }
}

#[test]
fn units_without_compiler_are_partial() {
    let (_folder, status, document) = certified("fmu3", "no-such-compiler");
    assert_eq!(status, Some(1));
    assert_eq!(document["verdict"], "partial");
}
