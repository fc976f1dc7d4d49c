//! Tests of the content of a certificate of a user's specification with all outputs that can be requested.

use std::path::Path;

use eomgen_model_spec::source::sha256;
use eomgen_tests::program::{run, run_accepted, text};
use serde_json::Value;

/// Lever that pushes a ram through a joint with play.
const LEVER: &str = r#"
[model]
name = "stamping_lever"
title = "Lever with a ram"

[parameters]
J = { value = 0.8, unit = "kg m^2", min = 0 }
m = { value = 2, unit = "kg", min = 0 }
l = { value = 400, unit = "mm" }
k = { value = 5e3, unit = "N/m" }
b = { value = "l/400", unit = "m" }
c = { value = 30, unit = "N s/m" }
g = { value = 9.81, unit = "m/s^2" }

[coordinates]
theta = { unit = "rad", initial = 0.3 }
x = { unit = "m" }

[inputs]
u = { unit = "N m" }

[definitions]
gap = "l*sin(theta) - x"

[kinetic]
lever = "1/2*J*dot(theta)^2"
ram = "1/2*m*dot(x)^2"

[potential]
joint = "1/2*k*deadzone(gap, b)^2"
weight = "m*g*x"

[forces]
rubbing = { on = "gap", value = "-c*contact(gap, b)*dot(gap)" }
motor = { on = "theta", value = "u" }

[observables]
gap = { value = "gap", unit = "m" }
"#;

/// All outputs that can be requested, except regimes.
const REQUESTED: &str =
    "bias_forces,inverse_dynamics,guard_rates,jacobians,products,linearisation,lanes";
const CHECKS: [&str; 16] = [
    "bias_forces",
    "inverse_dynamics",
    "guard_rates",
    "rates_by_state",
    "rates_by_inputs",
    "rates_by_parameters",
    "observables_by_state",
    "observables_by_inputs",
    "observables_by_parameters",
    "jacobian_vector_product",
    "vector_jacobian_product",
    "vector_jacobian_product_by_parameters",
    "emitted_requests",
    "linearisation",
    "lanes",
    "f32",
];

fn write_lever(folder: &Path) -> String {
    let path = folder.join("lever.toml");
    std::fs::write(&path, LEVER).expect("a file can be written");
    path.display().to_string()
}

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).expect(name)
}

fn document(text: &str) -> Value {
    serde_json::from_str(text).expect("one JSON document")
}

#[test]
fn all_requested_outputs_are_checked() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = write_lever(folder.path());
    let output = run(&["validate", &spec, "--with", REQUESTED, "--json"]);
    let certificate = document(&text(&output.stdout));
    assert_eq!(output.status.code(), Some(0), "{certificate:#}");
    for name in CHECKS {
        let mut checks = certificate["checks"].as_array().expect("checks").iter();
        let check = checks.find(|check| check["name"] == name).expect(name);
        assert_eq!(check["passed"], true, "{check}");
    }
    let with: Vec<&str> = REQUESTED.split(',').collect();
    assert_eq!(certificate["with"], serde_json::json!(with));
}

#[test]
fn certificate_contains_hashes_of_its_source() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = write_lever(folder.path());
    let out = folder.path().join("out");
    let place = out.display().to_string();
    let asked = ["--with", "inverse_dynamics"];
    let generate = ["generate", &spec, "--certify", "--out", &place];
    run_accepted(&[&generate[..], &asked].concat());
    let certificate = document(&read(&out, "certificate.json"));
    assert_eq!(certificate["schema"], 2);
    assert_eq!(certificate["model"], "stamping_lever");
    assert_eq!(certificate["passed"], true);
    assert_eq!(certificate["specification_sha256"], sha256(LEVER));
    assert_eq!(certificate["source_sha256"], sha256(read(&out, "lib.rs")));
    let version = run_accepted(&["--version"]);
    assert_eq!(certificate["generator"], version.trim());
    assert_eq!(certificate["parameters"]["l"], 0.4, "in SI");
    assert_eq!(certificate["parameters"]["b"], 0.001, "derived");
    let file = folder.path().join("validated.json").display().to_string();
    run_accepted(&[&["validate", &spec, "--out", &file][..], &asked].concat());
    let same = read(folder.path(), "validated.json") == read(&out, "certificate.json");
    assert!(
        same,
        "`validate` and `generate --certify` write the same bytes"
    );
}

#[test]
fn generate_without_certify_writes_no_certificate() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = write_lever(folder.path());
    let out = folder.path().join("out");
    run_accepted(&["generate", &spec, "--out", &out.display().to_string()]);
    assert!(!out.join("certificate.json").exists());
}

#[test]
fn partial_certificate_exits_with_1() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("lever.toml");
    let unreached =
        "motor = { on = \"theta\", value = \"u*(1 + above(theta*exp(-theta^2) - 0.5))\" }";
    let changed = LEVER.replace("motor = { on = \"theta\", value = \"u\" }", unreached);
    std::fs::write(&path, changed).expect("a file can be written");
    let spec = path.display().to_string();
    let output = run(&["validate", &spec, "--json"]);
    let certificate = document(&text(&output.stdout));
    assert_eq!(output.status.code(), Some(1), "{certificate:#}");
    assert_eq!(certificate["verdict"], "partial");
    assert_eq!(certificate["passed"], false);
    let coverage = serde_json::json!({ "regimes": 6, "sampled": 3, "unreachable": 0 });
    assert_eq!(certificate["coverage"], coverage);
    let checks = certificate["checks"].as_array().expect("checks");
    let of = |name: &str| {
        checks
            .iter()
            .find(|check| check["name"] == name)
            .expect("a check")
    };
    assert_eq!(of("coverage")["skipped"]["kind"], "not_run");
    assert_eq!(of("nesting_mass")["skipped"]["kind"], "not_applicable");
    assert_eq!(of("energy")["skipped"], false);
    let output = run(&["validate", &spec]);
    assert_eq!(output.status.code(), Some(1));
    let shown = text(&output.stdout);
    assert!(
        shown.contains("coverage: states were tried in 3 of 6 regimes"),
        "{shown}"
    );
    assert!(shown.contains("PARTIAL"), "{shown}");
}
