//! Tests of `eomgen generate --target c99`: written files, rejected options, and the documented example.

use std::path::Path;
use std::process::{Command, Output};

use eomgen_tests::models::{path, project};
use eomgen_tests::program::eomgen;

use super::{WARNINGS, has_compilers, run};

fn generate(out: &Path, options: &[&str]) -> Output {
    eomgen()
        .arg("generate")
        .arg(path("planetary_arm"))
        .args(["--target", "c99", "--out"])
        .arg(out)
        .args(options)
        .output()
        .expect("the program can be run")
}

#[test]
fn c_example_prints_documented_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let arm = folder.path().join("arm4");
    let output = generate(&arm, &["--order", "4"]);
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    for file in ["planetary_arm.c", "planetary_arm.h"] {
        assert!(said.contains(file) && arm.join(file).is_file(), "{said}");
    }
    if !has_compilers() {
        return;
    }
    let executable = folder.path().join("controller");
    run(Command::new("cc")
        .args(["-std=c99", "-O3", "-I"])
        .arg(&arm)
        .args(WARNINGS)
        .arg(project().join("examples/with_c/controller.c"))
        .arg(arm.join("planetary_arm.c"))
        .arg("-o")
        .arg(&executable));
    let printed = run(&mut Command::new(executable));
    assert_eq!(printed, "x_c = 0.000437 m after 10 ms\n");
    let text = std::fs::read_to_string(project().join("docs/embedding.md")).expect("a page");
    assert!(text.contains(&format!("./controller\n{printed}```")));
}

#[test]
fn rust_only_options_are_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    for (options, reason) in [
        (["--with", "bench"].as_slice(), "the benchmark is a crate"),
        (
            &["--with", "jacobians,lanes"],
            "generic over the number type",
        ),
    ] {
        let output = generate(&out, options);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(
            said.contains(reason) && said.contains("--target rust"),
            "{said}"
        );
        assert!(!out.exists(), "{options:?} wrote files");
    }
}

#[test]
fn certificate_covers_the_emitted_c() {
    if !has_compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let output = generate(folder.path(), &["--order", "1", "--certify"]);
    assert!(output.status.success(), "{output:?}");
    let text = std::fs::read_to_string(folder.path().join("certificate.json")).expect("a file");
    let certificate: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(certificate["verdict"], "passed");
    assert_eq!(
        certificate["source_sha256"],
        certificate["c_sources"][0]["source_sha256"]
    );
    let checks = certificate["checks"].as_array().expect("checks");
    let compiled = checks.iter().find(|check| check["name"] == "emitted_c");
    let compiled = compiled.expect("the C is compiled");
    assert_eq!(compiled["value"], 0.0, "{compiled}");
}

#[test]
fn json_lists_the_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = generate(folder.path(), &["--json"]);
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let files: Vec<&str> = document["files"]
        .as_array()
        .expect("files")
        .iter()
        .filter_map(|file| Path::new(file.as_str()?).file_name()?.to_str())
        .collect();
    assert_eq!(files, ["planetary_arm.c", "planetary_arm.h"]);
}
