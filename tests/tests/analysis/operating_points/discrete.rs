//! Comparison of `linearise --discrete` with simulated motions for piecewise constant inputs.

use eomgen_compiled_model::{CompiledModel, Instance, Orders, Request, Solver};
use eomgen_sim::inputs::HeldInputs;
use eomgen_tests::models::{path, project};
use eomgen_tests::program::run_rejected;
use serde_json::Value;

use super::{numbers, run_json, shipped};

/// Simulates one period by the Runge-Kutta method, with constant inputs.
fn state_after(run: &Instance<'_>, period: f64, state: &[f64], inputs: &[f64]) -> Vec<f64> {
    let request = Request {
        initial: state,
        times: &[0.0, period],
        inputs: &HeldInputs::constant(inputs.to_vec()),
        solver: Solver::Rk,
        tolerance: 1e-12,
        max_step: f64::INFINITY,
        audit: false,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {});
    let motion = motion.and_then(|motion| motion.into_complete());
    motion.expect("a motion").trajectory.final_state
}

fn matrix(document: &Value, name: &str) -> Vec<Vec<f64>> {
    let rows = document[name].as_array().expect("rows");
    rows.iter().map(numbers).collect()
}

/// Compares the columns of A_d and B_d with differences of motions, which are exact for linear machines. `point` is the
/// operating point; `deviation` and `input` are the changes of states and inputs.
fn compare(name: &str, point: &[(&str, f64)], period: f64, [deviation, input]: [f64; 2]) {
    let model = CompiledModel::load(path(name), Orders::Declared).expect("a model");
    let run = model.with_declared_parameters().expect("an instance");
    let names = model.state_names();
    let mut state = vec![0.0; names.len()];
    let mut arguments = vec!["linearise".to_owned(), shipped(name), "--json".to_owned()];
    for (known, value) in point {
        let place = names.iter().position(|own| own == known).expect("a state");
        state[place] = *value;
        arguments.extend(["--state".to_owned(), format!("{known}={value:?}")]);
    }
    arguments.extend(["--discrete".to_owned(), period.to_string()]);
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let document = run_json(&arguments);
    assert_eq!(document["period"], period);
    let rest = vec![0.0; model.model().inputs.len()];
    let base = state_after(&run, period, &state, &rest);
    for (matrix_name, size, count) in [("A_d", deviation, state.len()), ("B_d", input, rest.len())]
    {
        let found = matrix(&document, matrix_name);
        for column in 0..count {
            let (mut state, mut inputs) = (state.clone(), rest.clone());
            match matrix_name {
                "A_d" => state[column] += size,
                _ => inputs[column] += size,
            }
            let moved = state_after(&run, period, &state, &inputs);
            let right = moved.iter().zip(&base).map(|(to, from)| (to - from) / size);
            let right: Vec<f64> = right.collect();
            let scale = right
                .iter()
                .fold(0.0_f64, |most, entry| most.max(entry.abs()));
            for (row, right) in right.iter().enumerate() {
                let found = found[row][column];
                assert!(
                    (found - right).abs() < 1e-7 * scale,
                    "{name}: {matrix_name}[{row}][{column}] is {found:e}, the motion gives {right:e}"
                );
            }
        }
    }
}

#[test]
fn discrete_matrices_match_motions_with_held_inputs() {
    compare("loudspeaker", &[], 2e-4, [1e-6, 1e-3]);
    let contact = [("x_sp", 1e-3), ("x_pr", 1e-3)];
    // The meshes stay in contact during the period.
    compare("planetary_arm_rig", &contact, 2e-5, [1e-5, 1.0]);
}

#[test]
fn period_has_a_unit() {
    let document = run_json(&[
        "linearise",
        &shipped("loudspeaker"),
        "--discrete",
        "0.5 ms",
        "--json",
    ]);
    assert_eq!(document["period"], 5e-4);
}

#[test]
fn inadmissible_periods_and_prescribed_motion_are_rejected() {
    let pendulum = shipped("furuta_pendulum");
    for (period, message) in [
        ("0", "period 0.0 s: expected a time in s above 0"),
        ("-1e-3", "expected a time in s above 0"),
        ("nan", "expected a time in s above 0"),
        ("1e12", "use a shorter period"),
        ("1 kg", "a time is in s, not in kg"),
    ] {
        let period = format!("--discrete={period}");
        let at = ["--state", "theta=pi"];
        let said = run_rejected(&[&["linearise", &pendulum, &period][..], &at].concat());
        assert!(said.contains(message), "{period}: {said}");
    }
    let moving = project().join("tests/features/prescribed_motion.toml");
    let moving = moving.display().to_string();
    let said = run_rejected(&["linearise", &moving, "--discrete", "0.01"]);
    assert!(said.contains("is prescribed motion"), "{said}");
}
