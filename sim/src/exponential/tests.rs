use std::fs;
use std::path::Path;

use crate::inputs::HeldInputs;
use crate::piecewise_linear::PiecewiseLinear;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;

use super::{
    Directions, DrivingAccelerations, ExponentialIntegrator, MovedParameters, NoDrives, Options,
};

fn rig() -> Model {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models/planetary_arm_rig.toml");
    let text = fs::read_to_string(path).expect("the rig");
    eomgen_model_spec::check(Source::new("rig", &*text))
        .expect("valid")
        .model
}

fn torque(times: &[f64]) -> HeldInputs {
    let values = times
        .iter()
        .map(|t| (20.0 * t).sin() + 0.5 * (73.0 * t).sin());
    HeldInputs::new(times.to_vec(), values.collect(), 1).expect("as many values as times")
}

fn run(
    integrator: &mut ExponentialIntegrator,
    initial: &[f64],
    times: &[f64],
    inputs: &HeldInputs,
) -> Vec<Vec<f64>> {
    let mut states = Vec::new();
    let options = Options {
        force: None,
        tangents: None,
    };
    integrator
        .simulate(initial, times, inputs, options, &mut |_, state, _| {
            states.push(state.to_vec());
        })
        .expect("a motion");
    states
}

#[test]
fn integration_matches_exact_motion_through_events() {
    let model = rig();
    let exact = PiecewiseLinear::derive(&model, &[4]).expect("piecewise linear");
    let values: Vec<f64> = exact_values(&model);
    let times: Vec<f64> = (0..200).map(|k| f64::from(k) * 5e-4).collect();
    let inputs = torque(&times);
    let initial = vec![0.0; 14];
    let mut propagator = exact.propagator_at(&values).expect("a propagator");
    let wanted = propagator
        .simulate(&initial, (0.0, times[199]), &times, &inputs, &mut |_| {})
        .expect("a motion");
    assert!(wanted.events.len() > 20);
    let mut integrator =
        ExponentialIntegrator::new(exact.evaluator(&values), 5e-4, 1.0).expect("can be integrated");
    let found = run(&mut integrator, &initial, &times, &inputs);
    // Deflections of the meshes, the carrier coordinate and the modes, between micrometres and millimetres. A
    // sensor of the rig resolves 0.7 um.
    for (sample, (a, b)) in found.iter().zip(&wanted.states).enumerate() {
        for index in 0..7 {
            let difference = (a[index] - b[index]).abs();
            assert!(
                difference < 2e-8,
                "{index} at sample {sample}: {difference:e}"
            );
        }
    }
}

/// The functions of nested surfaces are zero in whole regions. The integrator would treat them as negative.
#[test]
fn nested_surfaces_are_rejected() {
    let text = r#"
[model]
name = "preload"
[parameters]
m = { value = 1, unit = "kg" }
F = { value = 10, unit = "N" }
b = { value = 0.1, unit = "m" }
[coordinates]
y = { unit = "m" }
[inputs]
u = { unit = "N" }
[kinetic]
T = "1/2*m*dot(y)^2"
[forces]
springs = { on = "y", value = "-F*JUMP" }
push = { on = "y", value = "u" }
"#;
    let is_integrated = |jump: &str| {
        let source = Source::new("preload", text.replace("JUMP", jump).as_str());
        let model = eomgen_model_spec::check(source).expect("valid").model;
        let exact = PiecewiseLinear::derive(&model, &[]).expect("piecewise linear");
        ExponentialIntegrator::new(exact.evaluator(&exact_values(&model)), 1e-3, 1.0).is_ok()
    };
    assert!(is_integrated("sign(y)"));
    assert!(is_integrated("above(dot(y))"));
    for jump in [
        "sign(deadzone(y, b))",
        "contact(contact(y, b), 0)",
        "sign(u)",
    ] {
        assert!(!is_integrated(jump), "{jump}");
    }
}

fn exact_values(model: &Model) -> Vec<f64> {
    let all = model.parameter_values().expect("values");
    let independent =
        model.parameters.iter().zip(&all).filter(|(p, _)| {
            matches!(p.value, eomgen_model_spec::model::ParameterValue::Number(_))
        });
    independent.map(|(_, value)| *value).collect()
}

#[test]
fn tangents_match_differences_of_neighbouring_motions() {
    let model = rig();
    let exact = PiecewiseLinear::derive(&model, &[4]).expect("piecewise linear");
    let values = exact_values(&model);
    let times: Vec<f64> = (0..60).map(|k| f64::from(k) * 5e-4).collect();
    let inputs = torque(&times);
    let mut initial = vec![0.0; 14];
    (initial[0], initial[7]) = (3e-5, 0.01);
    let mut integrator =
        ExponentialIntegrator::new(exact.evaluator(&values), 5e-4, 1.0).expect("can be integrated");
    let mut free = NoDrives;
    let mut tangents = integrator.create_tangents(by_state(), &mut free);
    let mut found = vec![0.0; 14 * 14];
    let options = Options {
        force: None,
        tangents: Some(&mut tangents),
    };
    integrator
        .simulate(&initial, &times, &inputs, options, &mut |_, _, tangents| {
            let tangents = tangents.expect("tangents");
            for index in 0..14 {
                let first = index * tangents.stride;
                found[index * 14..(index + 1) * 14]
                    .copy_from_slice(&tangents.vectors[first..first + 14]);
            }
        })
        .expect("a motion");
    let steps = [
        1e-9, 1e-9, 1e-9, 1e-8, 1e-8, 1e-8, 1e-8, 1e-6, 1e-6, 1e-6, 1e-5, 1e-5, 1e-5, 1e-5,
    ];
    for index in 0..14 {
        let mut ends = Vec::new();
        for sign in [1.0, -1.0] {
            let mut moved = initial.clone();
            moved[index] += sign * steps[index];
            ends.push(run(&mut integrator, &moved, &times, &inputs)[59].clone());
        }
        let scale: f64 = (0..7)
            .map(|k| found[index * 14 + k].abs())
            .fold(0.0, f64::max);
        for k in 0..7 {
            let quotient = (ends[0][k] - ends[1][k]) / (2.0 * steps[index]);
            let difference = (found[index * 14 + k] - quotient).abs();
            assert!(
                difference < 1e-2 * scale,
                "{k} by {index}: {difference:e} of {scale:e}"
            );
        }
    }
}

fn by_state() -> Directions {
    Directions {
        has_state_vectors: true,
        ..Directions::default()
    }
}

fn driven(driven: usize) -> Directions {
    Directions {
        driven_count: driven,
        ..Directions::default()
    }
}

/// Returns a mass of 2 kg with an input force and dry friction of 3 N.
fn sliding() -> Model {
    let text = r#"
[model]
name = "block"
[parameters]
m = { value = 2, unit = "kg" }
T = { value = 3, unit = "N" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
[kinetic]
block = "1/2*m*dot(x)^2"
[forces]
push = { on = "x", value = "u" }
friction = { on = "x", value = "-T*sign(dot(x))" }
"#;
    eomgen_model_spec::check(Source::new("block", text))
        .expect("valid")
        .model
}

#[test]
fn dry_friction_sticks_and_releases() {
    let model = sliding();
    let exact = PiecewiseLinear::derive(&model, &[]).expect("piecewise linear");
    let mut integrator = ExponentialIntegrator::new(exact.evaluator(&[2.0, 3.0]), 0.01, 1.0)
        .expect("can be integrated");
    // The mass sticks for 1 s, accelerates at 1 m/s^2 for 1 s, then decelerates at 1.5 m/s^2 until it sticks
    // again.
    let inputs = HeldInputs::new(vec![0.0, 1.0, 2.0], vec![2.0, 5.0, 0.0], 1).expect("inputs");
    let times: Vec<f64> = (0..=400).map(|k| f64::from(k) * 0.01).collect();
    let states = run(&mut integrator, &[0.0, 0.0], &times, &inputs);
    assert!(states[100][0].abs() < 1e-12);
    assert!((states[200][0] - 0.5).abs() < 1e-9 && (states[200][1] - 1.0).abs() < 1e-9);
    let stop = 0.5 + 1.0 / 3.0;
    assert!((states[400][0] - stop).abs() < 1e-9, "{:?}", states[400]);
    assert!(states[400][1].abs() < 1e-12);
}

/// An acceleration of 1 that drives the second of two vectors.
struct Push;

impl DrivingAccelerations for Push {
    fn write_differences(&mut self, _: f64, _: &[f64], _: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&[0.0, 1.0]);
    }
}

#[test]
fn driven_tangent_matches_response_to_acceleration() {
    let model = sliding();
    let exact = PiecewiseLinear::derive(&model, &[]).expect("piecewise linear");
    let mut integrator = ExponentialIntegrator::new(exact.evaluator(&[2.0, 3.0]), 0.01, 1.0)
        .expect("can be integrated");
    let inputs = HeldInputs::new(vec![0.0], vec![5.0], 1).expect("inputs");
    let times: Vec<f64> = (0..=100).map(|k| f64::from(k) * 0.01).collect();
    let mut push = Push;
    let mut tangents = integrator.create_tangents(driven(2), &mut push);
    let mut last = Vec::new();
    let options = Options {
        force: None,
        tangents: Some(&mut tangents),
    };
    integrator
        .simulate(
            &[0.0, 0.1],
            &times,
            &inputs,
            options,
            &mut |_, _, tangents| {
                let tangents = tangents.expect("tangents");
                last = tangents.vectors[..2 * tangents.stride].to_vec();
            },
        )
        .expect("a motion");
    let stride = last.len() / 2;
    assert!(last[0] == 0.0 && (last[stride] - 0.5).abs() < 1e-12);
}

/// Returns a motor of 80 kg that drives a table of 18 kg with dry friction of 41 N through a stiff screw.
fn axis() -> Model {
    let text = r#"
[model]
name = "axis"
[parameters]
J = { value = 80, unit = "kg" }
m = { value = 18, unit = "kg" }
k = { value = 24, unit = "N/um" }
c = { value = 9, unit = "N s/mm" }
F = { value = 41, unit = "N" }
[coordinates]
y = { unit = "m" }
x = { unit = "m" }
[inputs]
u = { unit = "N" }
[kinetic]
masses = "1/2*J*dot(y)^2 + 1/2*m*dot(x)^2"
[potential]
screw = "1/2*k*(y - x)^2"
[dissipation]
screw = "1/2*c*(dot(y) - dot(x))^2"
[forces]
motor = { on = "y", value = "u" }
friction = { on = "x", value = "-F*sign(dot(x))" }
"#;
    eomgen_model_spec::check(Source::new("axis", text))
        .expect("valid")
        .model
}

#[test]
fn release_within_step_is_located() {
    let model = axis();
    let exact = PiecewiseLinear::derive(&model, &[]).expect("piecewise linear");
    let values = exact_values(&model);
    let times: Vec<f64> = (0..500).map(|k| f64::from(k) * 2e-3).collect();
    let push = times.iter().map(|t| 200.0 * (9.0 * t).sin());
    let inputs = HeldInputs::new(times.clone(), push.collect(), 1).expect("inputs");
    let mut propagator = exact.propagator_at(&values).expect("a propagator");
    let span = (0.0, times[499]);
    let wanted = propagator
        .simulate(&[0.0; 4], span, &times, &inputs, &mut |_| {})
        .expect("a motion");
    assert!(wanted.events.len() >= 5);
    let mut integrator =
        ExponentialIntegrator::new(exact.evaluator(&values), 2e-3, 1.0).expect("can be integrated");
    let found = run(&mut integrator, &[0.0; 4], &times, &inputs);
    let differences = found.iter().zip(&wanted.states).map(|(a, b)| a[1] - b[1]);
    let most = differences.fold(0.0f64, |most, d| most.max(d.abs()));
    // If the release were applied at the end of the step, the error would be 2 um.
    assert!(most < 2e-9, "{most:e} m");
}

#[test]
fn driven_tangent_stays_on_sticking_surface() {
    let model = sliding();
    let exact = PiecewiseLinear::derive(&model, &[]).expect("piecewise linear");
    let mut integrator = ExponentialIntegrator::new(exact.evaluator(&[2.0, 3.0]), 0.01, 1.0)
        .expect("can be integrated");
    // The mass sticks for 1 s, then accelerates at 1 m/s^2.
    let inputs = HeldInputs::new(vec![0.0, 1.0], vec![2.0, 5.0], 1).expect("inputs");
    let times: Vec<f64> = (0..=200).map(|k| f64::from(k) * 0.01).collect();
    let mut push = Push;
    let mut tangents = integrator.create_tangents(driven(2), &mut push);
    let mut driven = Vec::new();
    let options = Options {
        force: None,
        tangents: Some(&mut tangents),
    };
    integrator
        .simulate(
            &[0.0; 2],
            &times,
            &inputs,
            options,
            &mut |_, _, tangents| {
                let tangents = tangents.expect("tangents");
                driven.push(tangents.vectors[tangents.stride]);
            },
        )
        .expect("a motion");
    assert!(driven[100].abs() < 1e-12, "{:e}", driven[100]);
    assert!((driven[200] - 0.5).abs() < 1e-3, "{:e}", driven[200]);
}

/// Returns the derivatives of the motion at its samples with respect to each independent
/// parameter.
fn by_parameters(
    exact: &PiecewiseLinear,
    values: &[f64],
    (initial, times): (&[f64], &[f64]),
    inputs: &HeldInputs,
) -> Vec<Vec<Vec<f64>>> {
    let sample = times[1] - times[0];
    let mut integrator = ExponentialIntegrator::new(exact.evaluator(values), sample, 1.0)
        .expect("can be integrated");
    let ends = (0..values.len()).map(|index| {
        let end = |change: f64| {
            let mut moved = values.to_vec();
            moved[index] += change;
            MovedParameters {
                values: moved,
                parameter_change: change,
            }
        };
        let size = 1e-4 * values[index];
        vec![end(-size), end(size)]
    });
    integrator.set_moved_parameters(values, ends.collect());
    let states = initial.len();
    let directions = Directions {
        parameter_count: values.len(),
        ..Directions::default()
    };
    let mut free = NoDrives;
    let mut tangents = integrator.create_tangents(directions, &mut free);
    let mut derivatives = Vec::new();
    let options = Options {
        force: None,
        tangents: Some(&mut tangents),
    };
    integrator
        .simulate(initial, times, inputs, options, &mut |_, _, tangents| {
            let tangents = tangents.expect("tangents");
            let vectors = tangents.vectors.chunks_exact(tangents.stride);
            derivatives.push(vectors.map(|vector| vector[..states].to_vec()).collect());
        })
        .expect("a motion");
    derivatives
}

#[test]
fn parameter_derivatives_match_exact_motion_with_friction_and_play() {
    let with_play = r#"
[model]
name = "play"
[parameters]
J_1 = { value = 0.01, unit = "kg m^2" }
J_2 = { value = 0.02, unit = "kg m^2" }
k = { value = 6000, unit = "N m/rad" }
d = { value = 3, unit = "N m s/rad" }
g = { value = 0.002, unit = "rad" }
[coordinates]
alpha = { unit = "rad" }
beta = { unit = "rad" }
[inputs]
u = { unit = "N m" }
[kinetic]
inertias = "1/2*J_1*dot(alpha)^2 + 1/2*J_2*dot(beta)^2"
[potential]
coupling = "1/2*k*deadzone(alpha - beta, g)^2"
[forces]
motor = { on = "alpha", value = "u" }
impact = { on = "alpha", value = "-d*dot(alpha)*above(alpha - beta - g)" }
"#;
    let play = eomgen_model_spec::check(Source::new("play", with_play))
        .expect("valid")
        .model;
    for (name, model, sample, size) in [("axis", axis(), 2e-3, 200.0), ("play", play, 1e-3, 1.0)] {
        let exact = PiecewiseLinear::derive(&model, &[]).expect("piecewise linear");
        let values = exact_values(&model);
        let times: Vec<f64> = (0..120).map(|k| f64::from(k) * sample).collect();
        let push = times.iter().map(|t| size * (22.0 * t).sin());
        let inputs = HeldInputs::new(times.clone(), push.collect(), 1).expect("inputs");
        let initial = [0.0, 1e-5, 0.0, 0.0];
        let found = by_parameters(&exact, &values, (&initial, &times), &inputs);
        let span = (0.0, times[119]);
        let motion = |values: &[f64]| {
            let mut propagator = exact.propagator_at(values).expect("a propagator");
            propagator
                .simulate(&initial, span, &times, &inputs, &mut |_| {})
                .expect("a motion")
        };
        assert!(motion(&values).events.len() >= 5, "{name}");
        for index in 0..values.len() {
            let step = 1e-7 * values[index];
            let [after, before] = [step, -step].map(|change| {
                let mut moved = values.clone();
                moved[index] += change;
                motion(&moved).states
            });
            // Impacts make neighbouring motions diverge, so later finite differences do not approximate
            // derivatives.
            for state in 0..2 {
                let wanted =
                    |sample: usize| (after[sample][state] - before[sample][state]) / (2.0 * step);
                let scale = (0..120)
                    .map(wanted)
                    .fold(0.0f64, |most, d| most.max(d.abs()));
                for (sample, found) in found.iter().enumerate() {
                    let difference = (found[index][state] - wanted(sample)).abs();
                    assert!(
                        difference <= 5e-4 * scale,
                        "{name}, state {state} by parameter {index} at sample {sample}: \
                         {difference:e} of {scale:e}"
                    );
                }
            }
        }
    }
}
