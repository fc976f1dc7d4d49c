//! Sensitivities of exact trajectories compared with difference quotients through many events, and
//! Lyapunov exponents compared with a closed form.

use std::path::Path;

use eomgen_model_spec::model::Model;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::piecewise_linear::{LyapunovRequest, PiecewiseLinear};

fn model(text_or_name: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../model-spec/models")
        .join(text_or_name);
    eomgen_model_spec::load(&path)
        .expect("the specification is right")
        .model
}

fn values(model: &Model, exact: &PiecewiseLinear) -> Vec<f64> {
    let all = model.parameter_values().expect("values");
    let index = |name: &String| model.parameters.iter().position(|p| p.name == *name);
    exact
        .parameter_names()
        .iter()
        .map(|name| all[index(name).expect("known")])
        .collect()
}

/// Returns the largest difference from the central difference quotient, and its largest magnitude.
fn compare(derivative: &[f64], plus: &[f64], minus: &[f64], step: f64) -> (f64, f64) {
    let quotient = plus.iter().zip(minus).map(|(a, b)| (a - b) / (2.0 * step));
    derivative
        .iter()
        .zip(quotient)
        .fold((0.0, 0.0), |(worst, size): (f64, f64), (d, q)| {
            (worst.max((d - q).abs()), size.max(q.abs()))
        })
}

#[test]
fn initial_state_derivatives_match_difference_quotients() {
    let model = model("planetary_arm.toml");
    let exact = PiecewiseLinear::derive(&model, &[1]).expect("piecewise linear");
    let values = values(&model, &exact);
    let initial = model.initial_state(&[1]).expect("initial state");
    let (none, samples) = (HeldInputs::zero(0), [0.02, 0.06]);
    for state in [0, 3, 4, 6] {
        let mut direction = vec![0.0; initial.len()];
        direction[state] = 1.0;
        let mut propagator = exact.propagator_at(&values).expect("a propagator");
        let found = propagator
            .simulate_with_derivatives(&initial, (0.0, 0.06), &samples, &none, vec![direction])
            .expect("sensitivities");
        // Steps of the difference quotient: well above the rounding of a trajectory and well below the effect
        // of an event; positions in m, rates in m/s.
        let step = if state < initial.len() / 2 {
            1e-10
        } else {
            1e-7
        };
        let shifted = |sign: f64| {
            let mut start = initial.clone();
            start[state] += sign * step;
            let mut propagator = exact.propagator_at(&values).expect("a propagator");
            propagator
                .simulate(&start, (0.0, 0.06), &samples, &none, &mut |_| {})
                .expect("a trajectory")
        };
        let (plus, minus) = (shifted(1.0), shifted(-1.0));
        for (k, derivative) in found.derivatives.iter().enumerate() {
            let (worst, size) = compare(&derivative[0], &plus.states[k], &minus.states[k], step);
            // The error is a rounding of 1e-14 m divided by the step, plus the step times the curvature.
            assert!(worst < 1e-3 * size, "{state}: {worst:e} of {size:e}");
        }
    }
}

#[test]
fn lyapunov_exponents_of_damped_oscillator_equal_its_decay() {
    let text = "[model]\nname = \"mass\"\ntitle = \"A mass\"\n[parameters]\n\
                m = { value = 2, unit = \"kg\" }\nk = { value = 50, unit = \"N/m\" }\n\
                c = { value = 0.8, unit = \"N s/m\" }\nF = { value = 1, unit = \"N\" }\n\
                omega = { value = 3, unit = \"rad/s\" }\n[coordinates]\nx = { unit = \"m\" }\n\
                [kinetic]\nmass = \"1/2*m*dot(x)^2\"\n[potential]\nspring = \"1/2*k*x^2\"\n\
                [forces]\nextra = { on = \"x\", value = \"F*sin(omega*t) - c*dot(x)\" }\n";
    let source = eomgen_model_spec::source::Source::new("mass.toml", text);
    let model = eomgen_model_spec::check(source).expect("right").model;
    let exact = PiecewiseLinear::derive(&model, &[]).expect("linear");
    let mut propagator = exact.propagator_for_model(&model).expect("a propagator");
    let request = LyapunovRequest {
        transient: 20.0,
        interval: 2.0,
        interval_count: 400,
        exponent_count: 2,
    };
    let growth = propagator
        .measure_lyapunov((0.0, &[0.1, 0.0]), &HeldInputs::zero(0), &request, &|| {})
        .expect("exponents");
    // Both exponents are -c/(2 m), up to the rotation of a vector within the last interval divided by the total
    // time.
    for growths in &growth.growth_exponents {
        let mean = growths.iter().sum::<f64>() / (growths.len() as f64 * growth.interval);
        assert!((mean + 0.2).abs() < 5e-3, "{mean}");
    }
}
