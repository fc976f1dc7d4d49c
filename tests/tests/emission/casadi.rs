//! Tests of the functions for CasADi: certificate, `verify`, families, and seeded faults. Python and CasADi are not
//! needed.

use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_tests::models::path;
use eomgen_tests::program::eomgen;
use serde_json::Value;
use tempfile::TempDir;

/// Returns true if there is a C compiler; otherwise reports the skip.
fn has_compiler() -> bool {
    let found = Command::new("cc").arg("--version").output().is_ok();
    if !found {
        skips::skip(
            "functions for CasADi were not compiled: cc is missing (Debian: apt-get install gcc)",
        );
    }
    found
}

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

fn verify(folder: &Path, more: &[&str]) -> (Option<i32>, String) {
    let file = "emps_casadi.c";
    run(
        folder,
        &[&["verify", file, "certificate.json"], more].concat(),
    )
}

/// Emits and certifies the functions for a drive with friction.
fn certified(with: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = path("emps");
    let spec = spec.to_string_lossy();
    let arguments = [
        "generate",
        &spec,
        "--target",
        "casadi",
        "--certify",
        "--out",
        ".",
    ];
    expect(folder.path(), 0, &[&arguments[..], with].concat());
    folder
}

fn certificate(folder: &Path) -> Value {
    let text = std::fs::read_to_string(folder.join("certificate.json")).expect("a certificate");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn certificate_covers_functions_for_casadi() {
    if !has_compiler() {
        return;
    }
    let folder = certified(&["--with", "hessians"]);
    let document = certificate(folder.path());
    assert_eq!(document["verdict"], "passed");
    assert_eq!(document["casadi"]["name"], "emps");
    assert_eq!(document["casadi"]["with"], serde_json::json!(["hessians"]));
    assert_eq!(
        document["source_sha256"],
        document["casadi"]["source_sha256"]
    );
    let checks = document["checks"].as_array().expect("checks");
    for name in [
        "emitted_casadi",
        "hessians",
        "rates_by_time",
        "rates_by_state",
    ] {
        let check = checks.iter().find(|check| check["name"] == name);
        assert_eq!(check.expect(name)["passed"], true, "{name}");
    }
    let (status, said) = verify(folder.path(), &["--cc", "cc -std=c99 -O0"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("hash: as certified"), "{said}");
    let image = ["identify", "emps_casadi.c", "--certificates", "."];
    expect(folder.path(), 0, &image);
}

#[test]
fn seeded_faults_in_functions_for_casadi_are_found() {
    if !has_compiler() {
        return;
    }
    let folder = certified(&["--with", "hessians"]);
    let file: PathBuf = folder.path().join("emps_casadi.c");
    let text = std::fs::read_to_string(&file).expect("a file");
    let faults = [
        ("F_v = R(210.0)", "F_v = R(211.0)", "emitted_casadi"),
        (r#"{"q", "q_dot"}"#, r#"{"q_dot", "q"}"#, "emitted_casadi"),
        (
            r#""t", "x", "u", "p"}"#,
            r#""t", "u", "x", "p"}"#,
            "emitted_casadi",
        ),
        (
            "CASADI_SYMBOL_EXPORT int rates(",
            "CASADI_SYMBOL_EXPORT int rate(",
            "emitted_casadi",
        ),
        ("if (res[1] || res[2])", "if (res[1])", "emitted_casadi"),
        ("product[2] = -(", "product[2] = (", "hessians"),
    ];
    for (from, to, check) in faults {
        assert!(text.contains(from), "{from}");
        std::fs::write(&file, text.replacen(from, to, 1)).expect("written");
        let (status, said) = verify(folder.path(), &[]);
        assert_eq!(status, Some(1), "{from}: {said}");
        let mut failed = said.lines().filter(|line| line.contains("FAILED"));
        assert!(failed.any(|line| line.contains(check)), "{from}: {said}");
    }
}

#[test]
fn functions_for_casadi_without_compiler_are_partial() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = path("pendulum");
    let mut command = eomgen();
    command
        .env("CC", "no-such-compiler")
        .current_dir(folder.path());
    command.arg("generate").arg(spec);
    let output = command
        .args(["--target", "casadi", "--certify", "--out", "."])
        .output();
    let output = output.expect("the program can be run");
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let document = certificate(folder.path());
    assert_eq!(document["verdict"], "partial");
    let checks = document["checks"].as_array().expect("checks");
    let check = checks
        .iter()
        .find(|check| check["name"] == "emitted_casadi");
    assert_eq!(check.expect("a check")["skipped"]["kind"], "not_run");
}

#[test]
fn family_certifies_functions_for_casadi() {
    if !has_compiler() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let spec = path("pendulum");
    let family = format!(
        "[family]\nname = \"swings\"\n[[variant]]\nname = \"swing\"\nspec = {spec:?}\ntargets = [\"casadi\"]\n\
         [[variant]]\nname = \"both\"\nspec = {spec:?}\ntargets = [\"c99\", \"casadi\"]\nwith = [\"hessians\"]\n\
         [[variant]]\nname = \"planned\"\nspec = {spec:?}\ntargets = [\"acados\", \"casadi\"]\n"
    );
    std::fs::write(folder.path().join("family.toml"), family).expect("written");
    let write = ["family", "family.toml", "--out", "models"];
    expect(folder.path(), 0, &write);
    expect(
        folder.path(),
        0,
        &[&write[..], &["--check", "--force"]].concat(),
    );
    for (variant, file) in [
        ("swing", "swing_casadi.c"),
        ("both", "both_casadi.c"),
        ("both", "both.c"),
        ("planned", "planned_casadi.c"),
    ] {
        let variant = format!("models/{variant}");
        let (file, document) = (
            format!("{variant}/{file}"),
            format!("{variant}/certificate.json"),
        );
        let said = expect(folder.path(), 0, &["verify", &file, &document]);
        let check = match file.ends_with("_casadi.c") {
            true => "passed   The compiled functions for CasADi",
            false => "passed   The compiled C",
        };
        assert!(said.contains(check), "{said}");
    }
    assert!(
        folder
            .path()
            .join("models/planned/planned_acados.py")
            .exists()
    );
    let wrong = [
        "verify",
        "models/both/both_casadi.c",
        "models/swing/certificate.json",
    ];
    let said = expect(folder.path(), 2, &wrong);
    assert!(
        said.contains("the certificate covers swing_casadi.c"),
        "{said}"
    );
    // A certificate of C does not cover Rust.
    std::fs::write(folder.path().join("lib.rs"), "pub struct Both;\n").expect("written");
    let said = expect(
        folder.path(),
        2,
        &["verify", "lib.rs", "models/both/certificate.json"],
    );
    let cause = "the certificate covers both.c and both_casadi.c, not Rust";
    assert!(
        said.contains(cause) && !said.contains("was edited"),
        "{said}"
    );
    let file = folder.path().join("models/swing/swing_casadi.c");
    let text = std::fs::read_to_string(&file).expect("a file");
    std::fs::write(&file, text + "\n").expect("written");
    let said = expect(folder.path(), 1, &[&write[..], &["--check"]].concat());
    assert!(
        said.contains("swing: edited: swing/swing_casadi.c"),
        "{said}"
    );
}

/// Parameters are at the kink of a piecewise function: half-width 0, stiffness 0, equal limits.
#[test]
fn hessians_at_kinks_of_parameters_pass() {
    if !has_compiler() {
        return;
    }
    for (b, k, potential) in [
        ("0", "100", "1/2*k*deadzone(x, b)^2"),
        ("1e-12", "100", "1/2*k*deadzone(x, b)^2"),
        ("0", "100", "1/2*k*deadzone(x - b, max(b, 0))^2"),
        ("0.1", "0", "1/2*(k + abs(k))*(x - b)^2"),
        ("0.1", "0", "1/2*max(k, -k)*sin(x/b)*x^2"),
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        let text = format!(
            "[model]\nname = \"block\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
             k = {{ value = {k}, unit = \"N/m\" }}\nb = {{ value = {b}, unit = \"m\" }}\n\
             [coordinates]\nx = {{ unit = \"m\" }}\n[kinetic]\nblock = \"1/2*m*dot(x)^2\"\n\
             [potential]\nspring = \"{potential}\"\n"
        );
        std::fs::write(folder.path().join("block.toml"), text).expect("written");
        let generate = [
            "generate",
            "block.toml",
            "--target",
            "casadi",
            "--with",
            "hessians",
        ];
        let arguments = [&generate[..], &["--certify", "--out", "."]].concat();
        expect(folder.path(), 0, &arguments);
    }
}
