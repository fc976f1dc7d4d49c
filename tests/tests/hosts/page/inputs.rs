//! Inputs and initial states of interactive pages: an input has one control whose rates follow from its signal, and
//! the motion begins on the constraints.

use std::process::Command;

use eomgen_compiled_model::{CompiledModel, Orders};
use eomgen_tests::models::{path, project};
use eomgen_tests::program::{run_accepted, text};
use serde_json::Value;

use super::bits::node;
use super::write_page;

fn run_node(arguments: &[String]) -> Value {
    let output = Command::new("node")
        .args(arguments)
        .output()
        .expect("node can be run");
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn file(name: &str) -> String {
    project().join(name).display().to_string()
}

#[test]
fn prescribed_input_has_one_control() {
    let spec = path("crane").display().to_string();
    let page = run_accepted(&["page", &spec, "--out", "-"]);
    let model = eomgen_model_spec::load(&path("crane"))
        .expect("it loads")
        .model;
    let own = model
        .inputs
        .iter()
        .filter(|input| input.rate_of.is_none())
        .count();
    assert!(own < model.inputs.len(), "the model has rates of inputs");
    assert_eq!(
        page.matches("data-signal").count() - script_mentions(&page),
        own
    );
    assert!(!page.contains("ddot</mi>"));
    for form in ["constant", "sine", "step"] {
        assert!(
            page.contains(&format!("<option value=\"{form}\"")),
            "{form}"
        );
    }
}

#[test]
fn machine_at_rest_starts_with_a_sine() {
    let page = |name: &str| {
        let spec = path(name).display().to_string();
        run_accepted(&["page", &spec, "--out", "-"])
    };
    let resting = page("emps");
    assert!(resting.contains("Without inputs this machine stays at rest."));
    assert!(resting.contains("<option value=\"sine\" selected>"));
    let moving = page("crane");
    assert!(!moving.contains("stays at rest"));
    assert!(!moving.contains("<option value=\"sine\" selected>"));
}

/// Returns the number of mentions in the script.
fn script_mentions(page: &str) -> usize {
    let script = page.rsplit("<script>").next().unwrap_or_default();
    script.matches("data-signal").count()
}

#[test]
fn rates_of_signals_are_derivatives() {
    if !node() {
        return;
    }
    let scripts = [
        "tests/tests/hosts/page/signals.mjs",
        "cli/src/page/play/signals.js",
    ];
    let seen = run_node(&scripts.map(file));
    assert_eq!(seen["forms"], 3);
    assert!(seen["largest"].as_f64().expect("a number") < 1e-3, "{seen}");
    assert_eq!(seen["end"], serde_json::json!([2, 0, 0]), "{seen}");
}

#[test]
fn page_projects_states_like_simulate() {
    if !node() {
        return;
    }
    let spec = project().join("examples/constrained/squeezing_mechanism.toml");
    let folder = tempfile::tempdir().expect("a folder");
    let page = write_page(&spec, &[], folder.path());
    let compiled = CompiledModel::load(&spec, Orders::Declared).expect("it loads");
    let run = compiled.with_declared_parameters().expect("it runs");
    let mut state = run.initial_state().to_vec();
    state[1] += 0.01;
    let (expected, moved) = run
        .find_consistent_state(&state, 0.0, &run.default_inputs())
        .expect("a consistent state");
    assert!(!moved.is_empty());
    let scripts = [
        "tests/tests/hosts/page/constraints.mjs",
        "sim/page/src/play/motion.js",
        "cli/src/page/play/constraints.js",
    ];
    let [script, motion, constraints] = scripts.map(file);
    let given = serde_json::to_string(&state).expect("JSON");
    let seen = run_node(&[
        script,
        page.display().to_string(),
        motion,
        constraints,
        given,
    ]);
    assert_eq!(
        seen["outcomes"],
        serde_json::json!(["moved", "unchanged"]),
        "{seen}"
    );
    let found = seen["state"].as_array().expect("a state").iter();
    for (found, expected) in found.zip(&expected) {
        let found = found.as_f64().expect("a number");
        assert!((found - expected).abs() < 1e-7, "{found}, not {expected}");
    }
}
