//! Tests of `eomgen paper study`: complete folders, readable figures, and comparison of numbers with independent
//! formulas.

use std::path::Path;
use std::time::Duration;

use eomgen_tests::models::project;
use eomgen_tests::program::{eomgen, run_accepted, run_rejected, text};
use serde_json::Value;

fn run_study(name: &str, out: &Path) -> Value {
    let mut command = eomgen();
    command.timeout(Duration::from_secs(600));
    command
        .args(["paper", "study", name, "--json", "--out"])
        .arg(out);
    let output = command.output().expect("the program can be run");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let written = std::fs::read(out.join("study.json")).expect("study.json");
    assert_eq!(written, output.stdout, "--json prints the written document");
    serde_json::from_slice(&written).expect("JSON")
}

fn list<'a>(document: &'a Value, name: &str) -> &'a [Value] {
    document[name].as_array().expect(name)
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn file(out: &Path, name: &Value) -> Vec<u8> {
    let name = name.as_str().expect("the name of a file");
    std::fs::read(out.join(name)).expect(name)
}

#[test]
fn study_writes_all_files_of_its_document() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("made/on the way");
    let document = run_study("frequency", &out);
    assert_eq!(
        (&document["schema"], &document["study"]),
        (&Value::from(2), &Value::from("frequency"))
    );
    let figures = list(&document, "figures");
    for number in 11..=15 {
        let paper = Value::from(format!("Fig. {number}"));
        assert!(figures.iter().any(|f| f["paper"] == paper), "{paper}");
    }
    for figure in figures {
        let svg = file(&out, &figure["file"]);
        assert!(svg.starts_with(b"<svg") && svg.ends_with(b"</svg>\n"));
    }
    let assumed = ["I", "a_m", "b_m", "F_w", "c_sp", "c_pr"];
    for (name, parameter) in document["parameters"].as_object().expect("parameters") {
        let expected = if assumed.contains(&&**name) {
            "assumed"
        } else {
            "paper"
        };
        assert_eq!(parameter["origin"], expected, "{name}");
    }
    let cases = list(&document, "cases");
    assert_eq!(cases.len(), 5);
    for case in cases {
        for data in ["history", "spectra", "section"] {
            assert!(file(&out, &case[data]).starts_with(b"PAR1"), "{case}");
        }
        check_numbers(case);
    }
    check_closed_form(&cases[0]);
    check_frequencies(&cases[0]);
    let drawn = |name: &str| figures.iter().any(|figure| figure["file"] == name);
    assert!(drawn("bifurcation.svg"));
    for name in ["arm.svg", "machine.svg"] {
        assert!(drawn(name), "{name}");
        let shown = std::fs::read(project().join("docs").join(name)).expect("a figure");
        let left = std::fs::read(out.join(name)).expect("a figure");
        assert!(left == shown, "docs/{name} differs from the study's figure");
    }
}

/// Checks the first frequency. If the meshes are closed, the drive turns with the arm. The frequency is higher than the
/// frequency of the clamped arm; the coupling h^2/m with the inertia of the drive determines the difference.
fn check_frequencies(case: &Value) {
    let first = number(&case["natural_frequencies"][0]);
    let (beta, arm) = (1.875_104_069_f64, 7900.0 * 1e-4 * 0.5_f64.powi(3));
    let stiffness = 2e11 * 8.333e-10 / (7900.0 * 1e-4 * 0.5_f64.powi(4));
    let clamped = beta.powi(2) * stiffness.sqrt() / std::f64::consts::TAU;
    let tooth = 3e-3_f64 * 24.6_f64.to_radians().cos() / 2.0;
    let (r_s, r_c) = (27.0 * tooth, 3e-3 * 63.0 / 2.0);
    let sun = (0.39 + 3.0 * 0.61 / 4.0) * r_s * r_s;
    let ratio = 1.0 + 99.0 / 27.0;
    let whole = (6.29 + 3.0 * 0.66) * r_c * r_c + sun * ratio * ratio + arm / 3.0;
    let expected = clamped / (1.0 - 4.0 * arm / beta.powi(4) / whole).sqrt();
    // Mesh compliance and higher modes change the frequency by less than 1 part in 1000.
    assert!(
        (first / expected - 1.0).abs() < 1e-3,
        "{first} Hz, expected {expected} Hz"
    );
    assert!(
        (clamped - 32.5).abs() < 0.1 && (first - 37.3).abs() < 0.1,
        "{clamped} {first}"
    );
}

fn check_numbers(case: &Value) {
    for name in ["x_sp", "f_la", "l_dtheta", "dr"] {
        let [rms, peak] = ["rms", "peak"].map(|of| number(&case[name][of]));
        assert!(0.0 < rms && rms <= peak, "{name}: {case}");
    }
    // At every time, f_la is the sum of the other two; the bound exceeds the rounding error of the sum.
    let peak = |name: &str| number(&case[name]["peak"]);
    let sum = peak("l_dtheta") + peak("dr");
    assert!(peak("f_la") <= sum * (1.0 + 1e-12), "{case}");
    // The torque changes its sign, so the meshes close on both sides.
    assert!(peak("x_sp") > number(&case["b"]), "{case}");
    let verdict = case["verdict"].as_str().expect("a sentence");
    let motion = case["motion"].as_str().expect("a kind of motion");
    assert!(verdict.starts_with(motion), "{case}");
}

/// Checks the closed form. Without backlash, forced motion far below all natural frequencies equals the motion of a
/// rigid machine. The meshes transmit the torque ripple minus the torque that accelerates the sun.
fn check_closed_form(case: &Value) {
    assert_eq!(number(&case["b"]), 0.0);
    // Each of the two meshes changes flanks twice in each of the five periods per second.
    let switches = number(&case["switches_per_second"]);
    assert!((switches - 20.0).abs() < 1e-12, "{switches}");
    let tooth = 3e-3_f64 * 24.6_f64.to_radians().cos() / 2.0;
    let (r_s, r_c) = (27.0 * tooth, 3e-3 * 63.0 / 2.0);
    let (sun, planet) = (0.39 * r_s * r_s, 0.61);
    let arm = 7900.0 * 1e-4 * 0.5_f64.powi(3) / 3.0;
    let carrier = 6.29 * r_c * r_c + 3.0 * 0.66 * r_c * r_c + arm;
    let ratio = 1.0 + 99.0 / 27.0;
    // The velocity of a planet along the line of action is half the velocity of the sun.
    let planets = 3.0 * planet * (r_s / 2.0).powi(2);
    let inertia = sun + planets + carrier / (ratio * ratio);
    let omega = number(&case["omega"]);
    let (f_w, b_m, k_sp) = (5.0, 0.05, 1e8);
    let rate = f_w / (inertia * omega).hypot(b_m);
    // In complex amplitudes: T - I_s alpha = 3 r_s k x_sp with T = F_w sin - b_m theta_s'. This torque accelerates the
    // remaining inertia.
    let expected = (inertia - sun) * omega * rate / (3.0 * r_s * k_sp);
    let found = number(&case["x_sp"]["peak"]);
    // At 5 Hz, bending increases the arm's part of the inertia by (5/37)^2 = 1.8 %, because the first natural frequency
    // is 37 Hz.
    assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
}

#[test]
fn remaining_studies_run_and_reproduce_documented_figures() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, figures) in [("order", 1), ("backlash", 6), ("flexibility", 4)] {
        let out = folder.path().join(name);
        let document = run_study(name, &out);
        assert_eq!(document["study"], name);
        let drawn = list(&document, "figures");
        assert!(drawn.len() >= figures, "{name}: {}", drawn.len());
        for figure in drawn {
            assert!(
                file(&out, &figure["file"]).ends_with(b"</svg>\n"),
                "{figure}"
            );
        }
    }
    // Rounding errors of matrix products depend on the processor and change chaotic motions, so numbers are compared on
    // one architecture only.
    if cfg!(target_arch = "x86_64") {
        let shown = std::fs::read(project().join("docs/fig_09.svg")).expect("a figure");
        let left = std::fs::read(folder.path().join("backlash/fig_09.svg")).expect("a figure");
        assert!(
            left == shown,
            "docs/fig_09.svg differs from the figure of `study backlash`"
        );
    }
}

#[test]
fn invalid_studies_are_rejected() {
    assert!(run_rejected(&["paper", "study", "fly", "--out", "never-made"]).contains("backlash"));
    assert!(run_rejected(&["paper", "study", "order"]).contains("--out"));
    assert!(run_accepted(&["paper", "study", "--help"]).contains("eomgen paper study backlash"));
}
