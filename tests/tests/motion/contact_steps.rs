//! Comparison of fixed steps with sticking friction and contacts with the event-driven solver and with closed forms.

use eomgen_compiled_model::{CompiledModel, Orders, Request, Solver};
use eomgen_sim::inputs::HeldInputs;
use eomgen_tests::contact_machines::{BALLS, BLOCK_ON_CART, PENDULUM, STRIBECK};
use eomgen_tests::program::run_rejected;

/// Returns the states at times (in s) with piecewise constant inputs.
fn states_at(
    specification: &str,
    (solver, max_step): (Solver, f64),
    inputs: &HeldInputs,
    times: &[f64],
) -> Vec<Vec<f64>> {
    let model = CompiledModel::from_text("machine.toml", specification, Orders::Declared);
    let model = model.expect("a model");
    let run = model.with_declared_parameters().expect("an instance");
    let request = Request {
        initial: run.initial_state(),
        times,
        inputs,
        solver,
        tolerance: 1e-11,
        max_step,
        audit: false,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {});
    let motion = motion.and_then(|motion| motion.into_complete());
    motion.expect("a motion").trajectory.states
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn errors_of_positions_are_proportional_to_the_step() {
    for (specification, coordinates, bound) in [
        (STRIBECK, 1, 0.3),
        (BALLS, 2, 6.0),
        (BLOCK_ON_CART, 3, 0.5),
        (PENDULUM, 2, 0.3),
    ] {
        let inputs = match specification.contains("[inputs]") {
            true => HeldInputs::constant(vec![1.0]),
            false => HeldInputs::zero(0),
        };
        let times: Vec<f64> = (0..=20).map(|k| f64::from(k) * 0.0625).collect();
        let right = states_at(specification, (Solver::Rk, f64::INFINITY), &inputs, &times);
        for exponent in [9, 11, 13] {
            let step = 0.5_f64.powi(exponent);
            let found = states_at(specification, (Solver::Fixed, step), &inputs, &times);
            let errors = found.iter().zip(&right);
            let errors =
                errors.map(|(a, b)| largest_difference(&a[..coordinates], &b[..coordinates]));
            let error = errors.fold(0.0, f64::max);
            assert!(error < bound * step, "{specification}{step}: {error}");
        }
    }
}

#[test]
fn body_held_by_friction_does_not_creep() {
    let held = STRIBECK.replace("initial = 0.3", "initial = 0.06");
    let load = HeldInputs::constant(vec![0.5]);
    let found = states_at(&held, (Solver::Fixed, 1e-3), &load, &[0.0, 100.0]);
    // The spring force of 2.4 N minus the load is below the static friction of 3 N and above the Coulomb friction.
    assert!((found[1][0] - 0.06).abs() < 1e-15, "{found:?}");
    assert!(found[1][1].abs() < 1e-15, "{found:?}");
    let released = STRIBECK.replace("initial = 0.3", "initial = 0.12");
    let found = states_at(&released, (Solver::Fixed, 1e-3), &load, &[0.0, 0.1]);
    assert!((found[1][0] - 0.12).abs() > 1e-3, "{found:?}");
}

#[test]
fn bounces_satisfy_newtons_law_and_end_at_rest() {
    let times = [0.0, 0.5, 3.0];
    let ball = BALLS.replace("balls = { when = \"z - y\", restitution = \"e\" }", "");
    let found = states_at(&ball, (Solver::Fixed, 1e-4), &HeldInputs::zero(0), &times);
    let (g, e) = (9.81_f64, 0.6);
    let fall = (2.0 * 0.4 / g).sqrt();
    let (rate, since) = (e * g * fall, 0.5 - fall);
    let height = rate * since - 0.5 * g * since * since;
    assert!((found[1][0] - height).abs() < 2e-4, "{found:?}");
    assert!((found[1][2] - (rate - g * since)).abs() < 2e-3, "{found:?}");
    // The bounces end after the time `fall` (1 + e)/(1 - e).
    assert!(
        found[2][0].abs() < 1e-9 && found[2][2].abs() < 1e-6,
        "{found:?}"
    );
}

#[test]
fn contacts_do_not_overlap_and_gain_no_energy() {
    let times: Vec<f64> = (0..=300).map(|k| f64::from(k) * 0.01).collect();
    let found = states_at(BALLS, (Solver::Fixed, 1e-3), &HeldInputs::zero(0), &times);
    let energy = |state: &Vec<f64>| {
        let [y, z, y_dot, z_dot] = state[..] else {
            panic!("four states");
        };
        0.75 * y_dot * y_dot + 0.25 * z_dot * z_dot + 9.81 * (1.5 * y + 0.5 * z)
    };
    let first = energy(&found[0]);
    for state in &found {
        assert!(state[0] > -1e-6 && state[1] - state[0] > -1e-3, "{state:?}");
        assert!(energy(state) < first + 0.02, "{state:?}");
    }
}

#[test]
fn steps_do_not_depend_on_the_unit_of_a_coordinate() {
    let scaled = STRIBECK
        .replace(
            "x = { unit = \"m\", initial = 0.3 }",
            "s = { unit = \"1\", initial = 300 }",
        )
        .replace(
            "[coordinates]",
            "l = { value = 1, unit = \"mm\" }\n[definitions]\nx = \"s*l\"\n[coordinates]",
        )
        .replace("on = \"x\", value = \"F\"", "on = \"s\", value = \"F*l\"")
        .replace("on = \"x\", value = \"-", "on = \"s\", value = \"-l*");
    let load = HeldInputs::constant(vec![1.0]);
    let times = [0.0, 0.25, 1.0];
    let [a, b] = [STRIBECK, &scaled].map(|specification| {
        states_at(specification, (Solver::Fixed, 1.0 / 1024.0), &load, &times)
    });
    for (a, b) in a.iter().zip(&b) {
        let b: Vec<f64> = b.iter().map(|entry| 1e-3 * entry).collect();
        assert!(largest_difference(a, &b) < 1e-12, "{a:?} {b:?}");
    }
}

#[test]
fn models_without_steps_of_fixed_length_are_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let out = path("rows.csv");
    for (specification, part) in [
        (
            BLOCK_ON_CART.replace("restitution = 0", "restitution = 0.5"),
            "contacts with both friction and restitution; remove the friction",
        ),
        (
            BLOCK_ON_CART.replace(
                "\"-T_c*sign(dot(X))\"",
                "\"-T_c*dot(X)/sqrt(dot(X)^2 + dot(x)^2)\"",
            ),
            "friction opposite to the direction of a velocity",
        ),
        (
            STRIBECK.replace("\"1/2*m*dot(x)^2\"", "\"1/2*m*(1 + above(x))*dot(x)^2\""),
            "energies that jump",
        ),
    ] {
        std::fs::write(path("machine.toml"), specification).expect("a file");
        let said = run_rejected(&[
            "simulate",
            &path("machine.toml"),
            "--solver",
            "fixed",
            "--step",
            "1e-3",
            "--until",
            "1",
            "--out",
            &out,
        ]);
        assert!(said.contains(part), "{said}");
        let said = run_rejected(&[
            "generate",
            &path("machine.toml"),
            "--with",
            "step",
            "--out",
            &path("emitted"),
        ]);
        assert!(said.contains(part), "{said}");
    }
}
