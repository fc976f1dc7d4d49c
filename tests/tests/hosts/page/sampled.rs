//! Comparison of sampled controllers on a page with `simulate`.

use std::sync::Arc;

use eomgen_compiled_model::{CompiledModel, Orders, Solver, SolverOptions};
use eomgen_sim::inputs::{HeldInputs, InputFunction};
use eomgen_tests::models::project;
use serde_json::{Value, json};

use super::bits::node;
use super::motion::{compare_page, move_page, numbers};

fn block() -> std::path::PathBuf {
    project().join("tests/tests/hosts/fmi/units/sampled_block.toml")
}

#[test]
fn controllers_with_delay_and_steps_match_simulate() {
    if !node() {
        return;
    }
    compare_page(&block(), 1.48, 1e-5);
    compare_page(
        &project().join("examples/closed_loop/regulator.toml"),
        1.0,
        1e-4,
    );
}

/// Reference signal of the page's controllers.
#[derive(Debug)]
struct Sine;

impl InputFunction for Sine {
    fn write(&self, t: f64, out: &mut [f64]) {
        out.fill(0.1 + 0.2 * (std::f64::consts::TAU * t / 1.6).sin());
    }
}

/// Signal of `r` in [`Sine`].
const SINE: [f64; 8] = [0.0, -1.0, -1.0, 1.0, 0.1, 0.2, 1.6, 1.0];

/// Time at which the period changes, in s; the first controller has a sample at this time.
const CHANGE: f64 = 0.72;

#[test]
fn changed_period_keeps_states_and_pending_outputs() {
    if !node() {
        return;
    }
    let spec = block();
    let compiled = CompiledModel::load(&spec, Orders::Declared).expect("it loads");
    let names = compiled.parameter_names();
    let place = names.iter().position(|name| name == "T").expect("a period");
    let times: Vec<f64> = (0..=37).map(|row| 0.04 * f64::from(row)).collect();
    let asked = json!({
        "times": times,
        "signals": [SINE],
        "parameters": [{ "time": CHANGE, "place": place, "value": 0.055 }],
    });
    let shown = move_page(&spec, &asked);
    assert_eq!(shown["reason"], "");
    let options = SolverOptions {
        solver: Solver::Rk,
        tolerance: 1e-11,
        ..SolverOptions::default()
    };
    let with_sine = |inputs: Vec<f64>| {
        let held = HeldInputs::constant(inputs);
        held.with_function(0, 1, Arc::new(Sine))
    };
    let run = compiled.with_declared_parameters().expect("it runs");
    let start = (0.0, run.initial_state());
    let begun = run.start_simulation(start, with_sine(vec![0.0; 3]), options);
    let mut simulation = begun.expect("a simulation");
    let later = compiled.with_parameters(&[("T", 55.0)]).expect("it runs");
    let rows = shown["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), times.len());
    for (row, t) in rows.iter().zip(&times) {
        if simulation.time() < CHANGE && *t >= CHANGE {
            simulation.advance(CHANGE).expect("an advance");
            let memory = simulation.control_memory().expect("controllers");
            assert_eq!(memory.pending.len(), 3);
            let state = simulation.state().to_vec();
            let inputs = with_sine(simulation.inputs().to_vec());
            let continued = later.continue_simulation((CHANGE, &state), inputs, options, &memory);
            simulation = continued.expect("a continuation");
        }
        simulation.advance(*t).expect("an advance");
        let found = numbers(&row["state"]);
        for (found, expected) in found.iter().zip(simulation.state()) {
            assert!(
                (found - expected).abs() < 1e-6,
                "{t} s: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn inadmissible_period_stops_the_page_with_its_reason() {
    if !node() {
        return;
    }
    let spec = block();
    let compiled = CompiledModel::load(&spec, Orders::Declared).expect("it loads");
    let names = compiled.parameter_names();
    let place = names.iter().position(|name| name == "T").expect("a period");
    let change = |time: f64, value: f64| json!({ "time": time, "place": place, "value": value });
    let asked = |parameters: Vec<Value>| json!({ "times": [0.5, 1.0], "signals": [SINE], "parameters": parameters });
    let shown = move_page(&spec, &asked(vec![change(0.7, 0.0)]));
    let reason = shown["reason"].as_str().expect("a text");
    assert!(
        reason.contains("the period of the controller `servo` is 0 s: give a time above 0"),
        "{reason}"
    );
}
