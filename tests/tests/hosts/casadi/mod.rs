//! Tests of the functions emitted for CasADi, called by CasADi: rates are compared bit for bit, Jacobians with finite
//! differences. Skipped with a message if CasADi is missing.
//!
//! The tests create Unix symbolic links.
#![cfg(unix)]

use std::path::Path;
use std::process::Command;

use eomgen_codegen::c::{CASADI_OUTPUTS, emit_casadi};
use eomgen_codegen::program::Output;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::variant::Variant;
use eomgen_tests::models::load;
use eomgen_tests::program::run_rejected;

/// Returns the command of a Python with CasADi; otherwise reports the skip.
fn python() -> Option<&'static str> {
    let found = Command::new("python3")
        .args(["-c", "import casadi, numpy"])
        .output();
    let there = found.is_ok_and(|output| output.status.success());
    if !there {
        skips::skip(
            "CasADi did not call the emitted functions: python3 with casadi and numpy is missing (pip install casadi)",
        );
    }
    there.then_some("python3")
}

fn check(name: &str, order: usize, with: &[Output], optimisation: &str, folder: &Path) {
    let model = load(name);
    let orders = vec![order; model.fields.len()];
    let outputs = [&CASADI_OUTPUTS, with].concat();
    let variant = Variant::derive_with(&model, &orders, &outputs).expect("derived");
    let text = emit_casadi(&variant.program).expect("emitted");
    let source = folder.join(format!("{name}_{}_casadi.c", with.len()));
    let library = folder.join(format!("{name}_{}.so", with.len()));
    std::fs::write(&source, text).expect("written");
    let compiled = Command::new("cc")
        .args([
            "-std=c99",
            "-pedantic",
            "-Wall",
            "-Wextra",
            "-Werror",
            optimisation,
        ])
        .args(["-shared", "-fPIC"])
        .arg(&source)
        .arg("-o")
        .arg(&library)
        .output()
        .expect("cc can be run");
    assert!(
        compiled.status.success(),
        "{}",
        String::from_utf8_lossy(&compiled.stderr)
    );
    let Some(python) = python() else { return };
    let program = variant.program;
    let states = program.states();
    let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
    let state: Vec<f64> = (0..states)
        .map(|i| 0.02 * (1 + i) as f64 * sign(i))
        .collect();
    let inputs: Vec<f64> = (0..program.inputs.len())
        .map(|i| 0.5 + 0.1 * i as f64)
        .collect();
    let mut rates = vec![0.0; states];
    let point = Point {
        t: 0.3,
        state: &state,
        inputs: &inputs,
    };
    Evaluator::new(program.clone()).rates(point, &mut rates);
    let output = Command::new(python)
        .arg(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/tests/hosts/casadi/check.py"
        ))
        .arg(&library)
        .arg(program.state_names().join(","))
        .args([program.inputs.len(), program.parameters.len()].map(|count| count.to_string()))
        .args(rates.iter().map(|rate| format!("{rate:e}")))
        .output()
        .expect("python can be run");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{name}: {said}");
}

#[test]
fn casadi_matches_emitted_functions() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, order) in [
        ("pendulum", 0),
        ("furuta_pendulum", 0),
        ("emps", 0),
        ("planetary_arm", 3),
        ("hub_beam_tip_mass", 2),
    ] {
        check(name, order, &[], "-O1", folder.path());
        check(name, order, &[Output::Hessians], "-O1", folder.path());
    }
    // With optimisation, the compilation of the second derivatives would take 24 s.
    check("two_link_arm", 1, &[Output::Hessians], "-O0", folder.path());
}

#[test]
fn with_is_rejected_for_casadi() {
    let spec = eomgen_tests::models::path("pendulum");
    let spec = spec.to_string_lossy();
    for (with, reason) in [
        ("jacobians", "their functions are rates and jac_rates"),
        ("hessians,jacobians", "accept --with hessians only"),
        ("lanes", "needs --target rust"),
        ("bench", "needs --target rust"),
    ] {
        let arguments = [
            "generate", &spec, "--target", "casadi", "--with", with, "--out", "x",
        ];
        let said = run_rejected(&arguments);
        assert!(said.contains(reason), "{said}");
    }
}

/// Runs the commands in the header comment of an example in a temporary folder; returns the output of the last command.
fn run_example(name: &str) -> String {
    let project = eomgen_tests::models::project();
    let page = std::fs::read_to_string(project.join("examples/with_casadi").join(name));
    let page = page.expect("an example");
    let head = page.split("\"\"\"").nth(1).expect("a docstring");
    let commands: Vec<&str> = head
        .lines()
        .filter_map(|l| l.strip_prefix("    "))
        .collect();
    assert!(commands.len() > 2, "{commands:?}");
    let folder = tempfile::tempdir().expect("a folder");
    for part in ["model-spec", "examples"] {
        let link = std::os::unix::fs::symlink(project.join(part), folder.path().join(part));
        link.expect("a link");
    }
    let program = eomgen_tests::program::path().display().to_string();
    let mut printed = String::new();
    for command in commands {
        let command = command.replacen("eomgen ", &format!("{program} "), 1);
        let output = Command::new("sh")
            .args(["-c", &command.replacen("python ", "python3 ", 1)])
            .current_dir(folder.path())
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .output()
            .expect("a shell");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{command}: {said}");
        printed = String::from_utf8_lossy(&output.stdout).into_owned();
    }
    print!("{printed}");
    printed
}

#[test]
fn pendulum_swings_up_from_linear_guess() {
    if python().is_some() {
        let printed = run_example("swing_up.py");
        assert!(
            printed.contains("time relative to CasADi symbols"),
            "{printed}"
        );
    }
}

#[test]
fn predictive_controller_example_runs() {
    if python().is_some() {
        let printed = run_example("track_tip.py");
        assert!(printed.contains("per sample"), "{printed}");
    }
}
