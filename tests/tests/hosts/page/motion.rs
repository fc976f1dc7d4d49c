//! Comparison of the motion of a page with `simulate`. The cases are shipped models and examples with sticking,
//! impacts, contact friction, constraints and corners, and random machines. Inputs over time, changed parameters, and
//! motions that end early are tested too.

use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_compiled_model::{CompiledModel, Instance, Motion, Orders, Request, Solver};
use eomgen_sim::inputs::HeldInputs;
use eomgen_tests::models::{path, project};
use eomgen_tests::random_numbers::Numbers;
use serde_json::{Value, json};

use super::bits::node;
use super::{drawn_example, write_page};

/// Relative tolerance of the reference.
const REFERENCE_TOLERANCE: f64 = 1e-11;

/// Number of compared samples.
const SAMPLES: usize = 20;

/// Simulates with the engine of a page; `asked` contains the times, the signals and other requests.
pub(super) fn move_page(spec: &Path, asked: &Value) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let output = Command::new("node")
        .arg(project().join("tests/tests/hosts/page/motion.mjs"))
        .arg(write_page(spec, &[], folder.path()))
        .arg(project().join("sim/page/src/play/engine.js"))
        .arg(asked.to_string())
        .output()
        .expect("node can be run");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {said}", spec.display());
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Returns the times of the samples, s.
fn times(until: f64) -> Vec<f64> {
    let samples = (0..=SAMPLES).map(|sample| until * sample as f64 / SAMPLES as f64);
    samples.collect()
}

/// Returns constant signals at the default inputs.
fn constant_signals(run: &Instance<'_>) -> Vec<[f64; 8]> {
    let inputs = run.model().default_inputs().into_iter().enumerate();
    let signals =
        inputs.map(|(place, value)| [place as f64, -1.0, -1.0, 0.0, value, 0.0, 1.0, 1.0]);
    signals.collect()
}

pub(super) fn numbers(list: &Value) -> Vec<f64> {
    let numbers = list.as_array().expect("a list").iter();
    numbers
        .map(|number| number.as_f64().unwrap_or(f64::NAN))
        .collect()
}

fn simulate(run: &Instance<'_>, times: &[f64], inputs: &HeldInputs) -> Motion {
    let request = Request {
        initial: run.initial_state(),
        times,
        inputs,
        solver: Solver::Rk,
        tolerance: REFERENCE_TOLERANCE,
        max_step: f64::INFINITY,
        audit: false,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {});
    motion.and_then(Motion::into_complete).expect("it moves")
}

/// Compares the rows of a page with a motion; differences are relative to the largest magnitude of a state or observable.
fn compare(name: &str, shown: &Value, run: &Instance<'_>, motion: &Motion, tolerance: f64) {
    assert_eq!(shown["reason"], "", "{name}");
    let rows = shown["rows"].as_array().expect("rows");
    let observables = run.observables(motion).expect("observables");
    let expected = motion.trajectory.states.iter().zip(&observables);
    let expected: Vec<Vec<f64>> = expected
        .map(|(state, observables)| [&state[..], observables].concat())
        .collect();
    assert_eq!(rows.len(), expected.len(), "{name}");
    let found = rows
        .iter()
        .map(|row| [numbers(&row["state"]), numbers(&row["observables"])].concat());
    let found: Vec<Vec<f64>> = found.collect();
    let states = motion.trajectory.states[0].len();
    for place in 0..expected[0].len() {
        let size = expected
            .iter()
            .map(|row| row[place].abs())
            .fold(1e-6, f64::max);
        for (row, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let error = (found[place] - expected[place]).abs() / size;
            let kind = if place < states {
                "state"
            } else {
                "observable"
            };
            assert!(
                error < tolerance,
                "{name}: {kind} {place} at {} s: {}, not {}",
                motion.trajectory.times[row],
                found[place],
                expected[place]
            );
        }
    }
}

/// Compares the page of a specification with `simulate`; returns the number of events.
pub(super) fn compare_page(spec: &Path, until: f64, tolerance: f64) -> usize {
    let name = spec.display().to_string();
    let compiled = CompiledModel::load(spec, Orders::Declared).expect("it loads");
    let run = compiled.with_declared_parameters().expect("it runs");
    let times = times(until);
    let asked = json!({ "times": times, "signals": constant_signals(&run) });
    let shown = move_page(spec, &asked);
    let motion = simulate(&run, &times, &run.default_inputs());
    compare(&name, &shown, &run, &motion, tolerance);
    let events = shown["events"].as_u64().expect("a number") as f64;
    let expected = motion.trajectory.events.len() as f64;
    assert!(
        (events - expected).abs() <= 0.02 * expected,
        "{name}: {events} events, not {expected}"
    );
    println!(
        "{name}: {expected} events, {:.3} s for {until} s",
        shown["seconds"].as_f64().unwrap_or(f64::NAN)
    );
    motion.trajectory.events.len()
}

fn example(name: &str) -> PathBuf {
    project().join("examples").join(name)
}

fn compare_text(text: &str, until: f64, tolerance: f64) -> usize {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("machine.toml");
    std::fs::write(&spec, text).expect("written");
    compare_page(&spec, until, tolerance)
}

#[test]
fn smooth_and_piecewise_motions_match_simulate() {
    if !node() {
        return;
    }
    compare_page(&path("pendulum"), 5.0, 1e-6);
    compare_page(&drawn_example("flexible_arm"), 2.0, 1e-5);
    assert!(compare_page(&path("planetary_arm"), 0.25, 1e-4) > 50);
}

#[test]
fn friction_and_impacts_match_simulate() {
    if !node() {
        return;
    }
    for (name, until) in [
        ("friction/cart_pole.toml", 4.0),
        ("friction/stopped_pendulum.toml", 4.0),
        ("friction/stribeck_belt.toml", 3.0),
        ("impacts/beam_stop.toml", 0.2),
        ("impacts/bouncing_ball.toml", 4.0),
        ("impacts/dropped_box.toml", 2.0),
        ("impacts/box_with_friction.toml", 2.0),
    ] {
        assert!(compare_page(&example(name), until, 1e-4) > 0, "{name}");
    }
}

#[test]
fn constrained_motions_match_simulate() {
    if !node() {
        return;
    }
    for (name, until) in [
        ("constrained/bicycle.toml", 2.0),
        ("constrained/rolling_disc.toml", 2.0),
        ("constrained/squeezing_mechanism.toml", 0.02),
        // This motion amplifies differences by a factor of a million in 0.5 s.
        ("constrained/flexible_coupler.toml", 0.05),
    ] {
        compare_page(&example(name), until, 1e-4);
    }
    compare_page(&path("chaplygin_sleigh"), 3.0, 1e-5);
}

#[test]
fn block_rests_under_dry_friction_from_any_direction() {
    if !node() {
        return;
    }
    let along = |force: &str, coordinates: &str| {
        format!(
            "[model]\nname = \"block\"\n\
             [parameters]\nm = {{ value = 2, unit = \"kg\" }}\nF = {{ value = 4, unit = \"N\" }}\n\
             [coordinates]\n{coordinates}\n[kinetic]\nblock = \"{force}\n"
        )
    };
    let line = along(
        "1/2*m*dot(x)^2\"\n[forces]\nfriction = { on = \"x\", value = \"-F*sign(dot(x))\" }",
        "x = { unit = \"m\", initial_rate = 3 }",
    );
    assert!(compare_text(&line, 3.0, 1e-7) > 0);
    let plane = along(
        "1/2*m*(dot(x)^2 + dot(y)^2)\"\n[definitions]\nv = \"norm([dot(x), dot(y)])\"\n[forces]\n\
         friction_x = { on = \"x\", value = \"-F*dot(x)/v\" }\nfriction_y = { on = \"y\", value = \"-F*dot(y)/v\" }",
        "x = { unit = \"m\", initial_rate = 3 }\ny = { unit = \"m\", initial_rate = -1 }",
    );
    assert!(compare_text(&plane, 3.0, 1e-7) > 0);
}

#[test]
fn potential_step_is_a_corner() {
    if !node() {
        return;
    }
    let text = "[model]\nname = \"line\"\n\
        [parameters]\nm = { value = 1, unit = \"kg\" }\nW = { value = 0.2, unit = \"J\" }\n\
        k = { value = 1, unit = \"N/m\" }\n\
        [coordinates]\nx = { unit = \"m\", initial = -1, initial_rate = 1 }\n\
        [kinetic]\nt = \"1/2*m*dot(x)^2\"\n[potential]\nstep = \"W*above(x)\"\nspring = \"1/2*k*x^2\"\n";
    assert!(compare_text(text, 6.0, 1e-6) > 1);
}

/// Returns a chain of masses on springs with random values, dry friction, a play and a wall.
fn random_chain(seed: u64) -> String {
    let mut drawn = Numbers(seed);
    let count = 2 + (seed as usize % 2);
    let mut text = "[model]\nname = \"chain\"\n[parameters]\n".to_owned();
    let mut value = |name: String, (low, high): (f64, f64), unit: &str| {
        let number = low + 0.5 * (high - low) * (1.0 + drawn.symmetric());
        text += &format!("{name} = {{ value = {number}, unit = \"{unit}\" }}\n");
    };
    for place in 1..=count {
        value(format!("m_{place}"), (0.5, 2.0), "kg");
        value(format!("k_{place}"), (50.0, 200.0), "N/m");
        value(format!("F_{place}"), (0.2, 2.0), "N");
    }
    value("b".to_owned(), (0.01, 0.05), "m");
    value("e".to_owned(), (0.3, 0.8), "1");
    value("wall".to_owned(), (0.1, 0.2), "m");
    let lines = |line: &dyn Fn(usize) -> String| (1..=count).map(line).collect::<String>();
    text += "[coordinates]\n";
    text += &lines(&|place| {
        format!(
            "x_{place} = {{ unit = \"m\", initial_rate = {} }}\n",
            2 - place as i32
        )
    });
    text += "[kinetic]\n";
    text += &lines(&|place| format!("mass_{place} = \"1/2*m_{place}*dot(x_{place})^2\"\n"));
    text += "[potential]\n";
    text += &lines(&|place| match place {
        1 => "spring_1 = \"1/2*k_1*deadzone(x_1, b)^2\"\n".to_owned(),
        _ => format!(
            "spring_{place} = \"1/2*k_{place}*(x_{place} - x_{})^2\"\n",
            place - 1
        ),
    });
    text += "[forces]\n";
    text += &lines(&|place| {
        format!(
            "friction_{place} = {{ on = \"x_{place}\", value = \"-F_{place}*sign(dot(x_{place}))\" }}\n"
        )
    });
    text += &format!("[impacts]\nwall = {{ when = \"wall - x_{count}\", restitution = \"e\" }}\n");
    text
}

#[test]
fn random_machines_match_simulate() {
    if !node() {
        return;
    }
    for seed in 1..=6 {
        assert!(
            compare_text(&random_chain(seed), 3.0, 1e-5) > 2,
            "seed {seed}"
        );
    }
}

#[test]
fn inputs_over_time_move_the_page() {
    if !node() {
        return;
    }
    let text = "[model]\nname = \"cart\"\n\
        [parameters]\nm = { value = 2, unit = \"kg\" }\nk = { value = 8, unit = \"N/m\" }\n\
        [coordinates]\nx = { unit = \"m\" }\n\
        [inputs]\ns = { unit = \"m\", rates = 2 }\nF = { unit = \"N\" }\n\
        [kinetic]\nmass = \"1/2*m*dot(x)^2\"\n[potential]\nspring = \"1/2*k*(x - s)^2\"\n\
        [forces]\ndrive = { on = \"x\", value = \"F - 0.5*(dot(x) - s_dot)\" }\n";
    let text = text.replace("0.5*", "c*").replace(
        "[coordinates]",
        "c = { value = 0.5, unit = \"kg/s\" }\n[coordinates]",
    );
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("cart.toml");
    std::fs::write(&spec, &text).expect("written");
    let times = times(4.0);
    // The signals are a sine with mean 0.1 m and amplitude 0.2 m, with its rate, and a step of the force from 1 N by 3
    // N.
    let signals = [
        [0.0, 1.0, 2.0, 1.0, 0.1, 0.2, 1.6, 1.0],
        [3.0, -1.0, -1.0, 2.0, 1.0, 3.0, 1.0, 0.5],
    ];
    let shown = move_page(&spec, &json!({ "times": times, "signals": signals }));
    let compiled = CompiledModel::load(&spec, Orders::Declared).expect("it loads");
    let run = compiled.with_declared_parameters().expect("it runs");
    let inputs = run
        .default_inputs()
        .with_function(0, 4, std::sync::Arc::new(Signals));
    let motion = simulate(&run, &times, &inputs);
    let states = |row: &Value| numbers(&row["state"]);
    let rows = shown["rows"].as_array().expect("rows").iter().map(states);
    for (found, expected) in rows.zip(&motion.trajectory.states) {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-6, "{found}, not {expected}");
        }
    }
}

/// Independent implementation of the signals of `inputs_over_time_move_the_page`.
#[derive(Debug)]
struct Signals;

impl eomgen_sim::inputs::InputFunction for Signals {
    fn write(&self, t: f64, out: &mut [f64]) {
        let w = std::f64::consts::TAU / 1.6;
        let u = ((t - 1.0) / 0.5).clamp(0.0, 1.0);
        out[0] = 0.1 + 0.2 * (w * t).sin();
        out[1] = 0.2 * w * (w * t).cos();
        out[2] = -0.2 * w * w * (w * t).sin();
        out[3] = 1.0 + 3.0 * u.powi(3) * (10.0 - 15.0 * u + 6.0 * u * u);
    }
}

#[test]
fn changed_parameter_acts_on_the_present_motion() {
    if !node() {
        return;
    }
    let spec = path("pendulum");
    let compiled = CompiledModel::load(&spec, Orders::Declared).expect("it loads");
    let names = compiled.parameter_names();
    let place = names.iter().position(|name| name == "g").expect("gravity");
    let run = compiled.with_declared_parameters().expect("it runs");
    let asked = json!({
        "times": [1.0, 3.0],
        "signals": constant_signals(&run),
        "parameters": [{ "time": 1.0, "place": place, "value": 1.62 }],
    });
    let shown = move_page(&spec, &asked);
    let before = simulate(&run, &[0.0, 1.0], &run.default_inputs());
    let moon = compiled.with_parameters(&[("g", 1.62)]).expect("it runs");
    let request = Request {
        initial: before.trajectory.states.last().expect("a state"),
        times: &[1.0, 3.0],
        inputs: &moon.default_inputs(),
        solver: Solver::Rk,
        tolerance: REFERENCE_TOLERANCE,
        max_step: f64::INFINITY,
        audit: false,
    };
    let after = moon
        .simulate_until_stop(&request, &mut |_| {})
        .expect("it moves");
    let found = numbers(&shown["rows"][1]["state"]);
    for (found, expected) in found
        .iter()
        .zip(after.trajectory.states.last().expect("a state"))
    {
        assert!((found - expected).abs() < 1e-6, "{found}, not {expected}");
    }
}

#[test]
fn page_starts_on_its_constraints_or_states_the_reason() {
    if !node() {
        return;
    }
    let spec = example("constrained/squeezing_mechanism.toml");
    let compiled = CompiledModel::load(&spec, Orders::Declared).expect("it loads");
    let run = compiled.with_declared_parameters().expect("it runs");
    let mut state = run.initial_state().to_vec();
    state[1] += 0.01;
    let signals = constant_signals(&run);
    let shown = move_page(
        &spec,
        &json!({ "times": [0.0], "signals": signals, "initial": state }),
    );
    let (expected, moved) = run
        .find_consistent_state(&state, 0.0, &run.default_inputs())
        .expect("a consistent state");
    assert!(!moved.is_empty() && shown["moved"] == true, "{shown}");
    for (found, expected) in numbers(&shown["rows"][0]["state"]).iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-10, "{found}, not {expected}");
    }
    let parameters: Vec<Value> = (0..compiled.parameter_names().len())
        .map(|place| json!({ "time": 0.001, "place": place, "value": 0.0 }))
        .collect();
    let asked = json!({ "times": [0.002], "signals": signals, "parameters": parameters });
    let refused = move_page(&spec, &asked);
    assert_ne!(refused["reason"], "", "{refused}");
}
