//! The motion shown by a page against `simulate`, and a block that comes to rest under dry
//! friction.

use std::path::Path;
use std::process::Command;

use eomgen_compiled_model::{CompiledModel, Orders, Solver};
use eomgen_tests::models::{path, project};
use serde_json::Value;

use super::bits::node;
use super::{drawn_example, write_page};

fn simulate_page(spec: &Path, end: f64) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let output = Command::new("node")
        .arg(project().join("tests/tests/hosts/page/motion.mjs"))
        .arg(write_page(spec, &[], folder.path()))
        .arg(project().join("sim/page/src/play/motion.js"))
        .arg(end.to_string())
        .output()
        .expect("node can be run");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {said}", spec.display());
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn numbers(list: &Value) -> Vec<f64> {
    let numbers = list.as_array().expect("a list").iter();
    numbers
        .map(|number| number.as_f64().expect("a number"))
        .collect()
}

#[test]
fn page_motion_matches_simulate() {
    if !node() {
        return;
    }
    for (spec, end, tolerance) in [
        (path("pendulum"), 5.0, 1e-5),
        (drawn_example("flexible_arm"), 2.0, 1e-4),
        (path("planetary_arm"), 0.25, 1e-4),
    ] {
        let shown = simulate_page(&spec, end);
        assert_eq!(shown["t"], end);
        let compiled = CompiledModel::load(&spec, Orders::Declared).expect("it loads");
        let run = compiled.with_declared_parameters().expect("it runs");
        let inputs = run.default_inputs();
        let motion = run.simulate(run.initial_state(), &[0.0, end], &inputs, Solver::Auto);
        let motion = motion.expect("it moves");
        let last = motion.trajectory.states.last().expect("a state");
        let size = last
            .iter()
            .fold(0.0, |size: f64, value| size.max(value.abs()));
        for (found, wanted) in numbers(&shown["state"]).iter().zip(last) {
            let error = (found - wanted).abs() / size;
            assert!(
                error < tolerance,
                "{}: {found}, not {wanted}",
                spec.display()
            );
        }
        let switches = motion.trajectory.events.len() as f64;
        let seen = shown["switches"].as_f64().expect("a number");
        assert!(
            (seen - switches).abs() <= 0.02 * switches,
            "{seen} switches, not {switches}"
        );
    }
}

#[test]
fn block_comes_to_rest_under_dry_friction() {
    if !node() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("block.toml");
    let text = "[model]\nname = \"block\"\n\
        [parameters]\nm = { value = 2, unit = \"kg\" }\nF = { value = 4, unit = \"N\" }\n\
        [coordinates]\nx = { unit = \"m\", initial_rate = 3 }\n\
        [kinetic]\nblock = \"1/2*m*dot(x)^2\"\n\
        [forces]\nfriction = { on = \"x\", value = \"-F*sign(dot(x))\" }\n";
    std::fs::write(&spec, text).expect("written");
    let shown = simulate_page(&spec, 10.0);
    // Expected: v^2/(2 F/m), reached after 1.5 s.
    let state = numbers(&shown["state"]);
    assert!(
        (state[0] - 2.25).abs() < 1e-3 && state[1].abs() < 1e-3,
        "{shown}"
    );
}
