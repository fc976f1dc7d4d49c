//! Tests of header-only C (`packaging = "header-only"`): family, certificate, `verify` and `identify`.

use std::path::Path;
use std::process::Command;

use eomgen_tests::models::path;
use eomgen_tests::program::eomgen;
use serde_json::Value;

/// Runs the program in a folder. Returns its status and output.
fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = eomgen().current_dir(folder).args(arguments).output();
    let output = output.expect("the program can be run");
    let said = [output.stdout, output.stderr].concat();
    (
        output.status.code(),
        String::from_utf8_lossy(&said).into_owned(),
    )
}

fn expect(folder: &Path, status: i32, arguments: &[&str]) -> String {
    let (found, said) = run(folder, arguments);
    assert_eq!(found, Some(status), "{arguments:?}\n{said}");
    said
}

fn family(targets: &str) -> String {
    let spec = path("pendulum");
    format!(
        "[family]\nname = \"swings\"\n[[variant]]\nname = \"swing\"\nspec = {spec:?}\ntargets = {targets}\n\
         packaging = \"header-only\"\nprecision = [\"f64\", \"f32\"]\nwith = [\"self_test\", \"trace\"]\n"
    )
}

#[test]
fn family_with_headers_is_certified_compared_verified_and_identified() {
    if Command::new("cc").arg("--version").output().is_err() {
        skips::skip(
            "emitted headers were not compiled: cc is missing (Debian: apt-get install gcc)",
        );
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("family.toml"), family("[\"rust\", \"c99\"]")).expect("written");
    let write = ["family", "family.toml", "--out", "models"];
    expect(folder, 0, &write);
    let check = [
        "family",
        "family.toml",
        "--out",
        "models",
        "--check",
        "--force",
    ];
    expect(folder, 0, &check);
    let swing = folder.join("models/swing");
    let mut names: Vec<String> = std::fs::read_dir(&swing)
        .expect("a folder")
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .into_string()
                .expect("a name")
        })
        .collect();
    names.sort();
    assert_eq!(
        names,
        [
            "baked.rs",
            "certificate.json",
            "mod.rs",
            "swing.h",
            "swing_baked.h",
            "swing_f32.h",
            "swing_f32_baked.h",
            "swing_f32_vectors.h",
            "trace.json",
            "vectors.h",
            "vectors.json",
            "vectors.rs"
        ]
    );
    let read = |name: &str| std::fs::read_to_string(swing.join(name)).expect(name);
    let certificate: Value = serde_json::from_str(&read("certificate.json")).expect("JSON");
    assert_eq!(certificate["verdict"], "passed");
    let trace: Value = serde_json::from_str(&read("trace.json")).expect("JSON");
    let lines = trace["files"]["swing.h"].as_array().expect("lines");
    assert!(!lines.is_empty());

    let verify = [
        "verify",
        "models/swing/swing.h",
        "models/swing/certificate.json",
    ];
    expect(folder, 0, &verify);
    let main = "#define swing_IMPLEMENTATION\n#include \"swing.h\"\n#include \"vectors.h\"\n\
                int main(void) {\n    return swing_self_test();\n}\n";
    std::fs::write(swing.join("main.c"), main).expect("written");
    let compiled = Command::new("cc")
        .current_dir(&swing)
        .args([
            "-std=c99",
            "-ffunction-sections",
            "-fdata-sections",
            "-Wl,--gc-sections",
        ])
        .args(["main.c", "-o", "main"])
        .status();
    assert!(compiled.expect("a compiler").success());
    let tested = Command::new(swing.join("main")).status().expect("a run");
    assert!(tested.success(), "{tested}");
    let identify = ["identify", "models/swing/main", "--certificates", "models"];
    assert!(expect(folder, 0, &identify).contains("certificate models/swing/certificate.json"));

    std::fs::write(swing.join("swing.h"), read("swing.h") + "\n").expect("written");
    let said = expect(folder, 1, &check);
    assert!(said.contains("swing: edited: swing/swing.h"), "{said}");
    let said = expect(folder, 1, &verify);
    assert!(said.contains("hash: DIFFERENT"), "{said}");
    std::fs::write(swing.join("swing.h"), read("swing.h") + "no C\n").expect("written");
    let said = expect(folder, 1, &verify);
    assert!(
        said.contains("swing.h: the emitted source failed"),
        "{said}"
    );
}

#[test]
fn declaration_header_cannot_be_verified() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let spec = path("pendulum");
    let spec = spec.to_str().expect("a path");
    let generate = |more: &[&str]| {
        run(
            folder,
            &[&["generate", spec, "--out", "out"], more].concat(),
        )
    };
    assert_eq!(generate(&["--target", "c99", "--certify"]).0, Some(0));
    let said = expect(
        folder,
        2,
        &["verify", "out/pendulum.h", "out/certificate.json"],
    );
    assert!(
        said.contains("declarations only: give the source next to it, pendulum.c"),
        "{said}"
    );
    let header_only = ["--packaging", "header-only", "--target", "c99", "--certify"];
    assert_eq!(generate(&header_only).0, Some(0));
    expect(
        folder,
        0,
        &["verify", "out/pendulum.h", "out/certificate.json"],
    );
    assert_eq!(generate(&["--packaging", "module", "--certify"]).0, Some(0));
    expect(folder, 0, &["verify", "out/mod.rs", "out/certificate.json"]);
    for (packaging, target) in [
        ("header-only", "rust"),
        ("module", "c99"),
        ("header-only", "cuda"),
    ] {
        let (status, said) = generate(&["--packaging", packaging, "--target", target]);
        assert_eq!(status, Some(2), "{said}");
        assert!(said.contains("need") && said.contains("--target"), "{said}");
    }
}

#[test]
fn header_without_c_is_rejected_with_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("family.toml"), family("[\"rust\"]")).expect("written");
    let said = expect(folder, 2, &["family", "family.toml", "--out", "models"]);
    assert!(
        said.contains("`packaging = \"header-only\"` needs the target \"c99\""),
        "{said}"
    );
    assert!(said.contains("family.toml:7"), "{said}");
}
