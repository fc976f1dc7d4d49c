//! Motions held by dry friction, with additional forces that depend on the direction of motion.

use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;

use crate::inputs::HeldInputs;
use crate::piecewise_linear::PiecewiseLinear;

use super::{ExponentialIntegrator, Options, UnsupportedModel};

/// Time between samples, s.
const SAMPLE_INTERVAL_S: f64 = 0.01;

/// Mass in kg, friction in N, damping in N s/m and length in m.
const PARAMETER_VALUES: [f64; 4] = [2.0, 3.0, 4.0, 0.5];

/// Returns a mass of 2 kg with an input force and this friction, in which T = 3 N and c = 4 N s/m.
fn block(friction: &str) -> Model {
    let text = format!(
        "[model]\nname = \"block\"\n[parameters]\n\
         m = {{ value = 2, unit = \"kg\" }}\nT = {{ value = 3, unit = \"N\" }}\n\
         c = {{ value = 4, unit = \"N s/m\" }}\nl = {{ value = 0.5, unit = \"m\" }}\n\
         [coordinates]\nx = {{ unit = \"m\" }}\n[inputs]\nu = {{ unit = \"N\" }}\n\
         [kinetic]\nT = \"1/2*m*dot(x)^2\"\n\
         [forces]\npush = {{ on = \"x\", value = \"u\" }}\nfriction = {{ on = \"x\", value = \"{friction}\" }}\n"
    );
    let source = Source::new("block", text.as_str());
    eomgen_model_spec::check(source).expect("valid").model
}

fn integrator(friction: &str) -> Result<ExponentialIntegrator, UnsupportedModel> {
    let exact = PiecewiseLinear::derive(&block(friction), &[]).expect("piecewise linear");
    ExponentialIntegrator::new(exact.evaluator(&PARAMETER_VALUES), SAMPLE_INTERVAL_S, 1.0)
}

/// Returns sample times (s) and an input with steps.
fn steps_of_force() -> (Vec<f64>, HeldInputs) {
    let times = (0..=200).map(|k| f64::from(k) * SAMPLE_INTERVAL_S);
    let changes = vec![0.0, 0.3, 0.8, 1.2, 1.5];
    let inputs = HeldInputs::new(changes, vec![8.0, -1.0, -7.0, 2.0, 6.0], 1);
    (times.collect(), inputs.expect("inputs"))
}

/// Returns the states of the block with this friction; it starts at rest.
fn simulate(friction: &str, times: &[f64], inputs: &HeldInputs) -> Vec<Vec<f64>> {
    let mut states = Vec::new();
    let options = Options {
        force: None,
        tangents: None,
    };
    let found = integrator(friction).expect("can be integrated").simulate(
        &[0.0, 0.0],
        times,
        inputs,
        options,
        &mut |_, state, _| states.push(state.to_vec()),
    );
    found.expect("a motion");
    states
}

#[test]
fn friction_holds_with_damping_that_differs_by_direction() {
    let (times, inputs) = steps_of_force();
    for friction in [
        "-T*sign(dot(x)) - c*abs(dot(x))",
        "-T*sign(dot(x)) - c*max(dot(x), 0)",
        "-T*sign(dot(x)) + c*min(dot(x), 0)",
        "-T*sign(dot(x)) - c*dot(x)*above(dot(x))",
        "-T*above(dot(x)) - c*dot(x)*sign(dot(x))",
    ] {
        let exact = PiecewiseLinear::derive(&block(friction), &[]).expect("piecewise linear");
        let mut propagator = exact
            .propagator_at(&PARAMETER_VALUES)
            .expect("a propagator");
        let expected = propagator
            .simulate(&[0.0, 0.0], (0.0, 2.0), &times, &inputs, &mut |_| {})
            .expect("a motion");
        let states = simulate(friction, &times, &inputs);
        for (t, (found, expected)) in times.iter().zip(states.iter().zip(&expected.states)) {
            let difference = (found[0] - expected[0]).abs();
            assert!(difference < 1e-9, "{friction} at {t} s: {difference:e}");
        }
    }
}

/// The forces on both sides have the same direction.
#[test]
fn friction_holds_with_forces_that_depend_on_input_and_position() {
    let (times, inputs) = steps_of_force();
    for friction in [
        "-(T + 0.1*u)*sign(dot(x)) - c*abs(dot(x))",
        "-(T + T*x/l)*sign(dot(x))",
        "-T*abs(x - l)/l*sign(dot(x))",
    ] {
        let states = simulate(friction, &times, &inputs);
        let expected = step_implicitly(friction, &times, &inputs);
        for (t, (found, expected)) in times.iter().zip(states.iter().zip(&expected)) {
            let difference = (found[0] - expected).abs();
            assert!(difference < 1e-5, "{friction} at {t} s: {difference:e}");
        }
    }
}

/// Returns positions computed with small steps that are implicit in the dry friction.
fn step_implicitly(friction: &str, times: &[f64], inputs: &HeldInputs) -> Vec<f64> {
    const PARTS: u32 = 10_000;
    let [mass, limit, damping, length] = PARAMETER_VALUES;
    let h = SAMPLE_INTERVAL_S / f64::from(PARTS);
    let (mut x, mut v) = (0.0_f64, 0.0_f64);
    let mut found = Vec::new();
    for t in times {
        found.push(x);
        let u = inputs.last_sample(t + 0.5 * SAMPLE_INTERVAL_S)[0];
        for _ in 0..PARTS {
            let (dry, viscous) = match friction {
                text if text.contains("abs(dot") => (limit + 0.1 * u, damping * v.abs()),
                text if text.contains("abs(x") => (limit * (x - length).abs() / length, 0.0),
                _ => (limit + limit * x / length, 0.0),
            };
            let free = v + h * (u - viscous) / mass;
            let most = h * dry / mass;
            v = free - free.clamp(-most, most);
            x += h * v;
        }
    }
    found
}

/// The share of the second mass in the force depends on the position.
#[test]
fn holding_forces_of_varying_direction_are_rejected() {
    let text = "[model]\nname = \"two\"\n[parameters]\n\
                m = { value = 2, unit = \"kg\" }\nT = { value = 3, unit = \"N\" }\n\
                l = { value = 0.5, unit = \"m\" }\n\
                [coordinates]\nx = { unit = \"m\" }\ny = { unit = \"m\" }\n\
                [kinetic]\nT = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n\
                [forces]\nfriction = { on = \"x\", value = \"-T*sign(dot(x))\" }\n\
                other = { on = \"y\", value = \"-T*y/l*sign(dot(x))\" }\n";
    let model = eomgen_model_spec::check(Source::new("two", text))
        .expect("valid")
        .model;
    let exact = PiecewiseLinear::derive(&model, &[]).expect("piecewise linear");
    let found =
        ExponentialIntegrator::new(exact.evaluator(&[2.0, 3.0, 0.5]), SAMPLE_INTERVAL_S, 1.0).err();
    assert_eq!(found, Some(UnsupportedModel::VaryingHoldingDirection));
}
