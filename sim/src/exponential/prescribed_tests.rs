//! Motions on a base that moves as s = t^3, which a spline reproduces, against closed forms.

use crate::cubic_spline::CubicSpline;
use crate::inputs::HeldInputs;
use crate::piecewise_linear::PiecewiseLinear;
use eomgen_model_spec::source::Source;

use super::{Directions, ExponentialIntegrator, NoDrives, Options};

/// Returns an integrator of a mass of 1 kg, with a force that depends on distance and speed relative to the
/// base.
fn integrator(force: &str, parameters: &[f64]) -> ExponentialIntegrator {
    let text = format!(
        r#"
[model]
name = "block"
[parameters]
m = {{ value = 1, unit = "kg" }}
k = {{ value = 9, unit = "N/m" }}
F = {{ value = 3, unit = "N" }}
[coordinates]
x = {{ unit = "m" }}
[inputs]
s = {{ unit = "m", rates = 2 }}
[kinetic]
block = "1/2*m*dot(x)^2"
[forces]
base = {{ on = "x", value = "{force}" }}
"#
    );
    let checked = eomgen_model_spec::check(Source::new("block", text)).expect("valid");
    let exact = PiecewiseLinear::derive(&checked.model, &[]).expect("piecewise linear");
    let evaluator = exact.evaluator(parameters).with_prescribed_states(vec![0]);
    ExponentialIntegrator::new(evaluator, 0.05, 1.0).expect("can be integrated")
}

fn samples() -> Vec<f64> {
    (0..=40).map(|k| 0.05 * f64::from(k)).collect()
}

fn base() -> HeldInputs {
    let values = samples().iter().map(|t| t.powi(3)).collect();
    let spline = CubicSpline::fit(samples(), values).expect("a spline");
    let held = HeldInputs::new(samples(), vec![0.0; 3 * samples().len()], 3);
    held.expect("as many values as times")
        .with_prescribed(0, spline)
}

#[test]
fn spring_to_the_base_is_exact_with_its_derivative() {
    let mut integrator = integrator("-k*(x - s)", &[1.0, 9.0, 3.0]);
    let mut free = NoDrives;
    let directions = Directions {
        has_state_vectors: true,
        ..Directions::default()
    };
    let mut tangents = integrator.create_tangents(directions, &mut free);
    let options = Options {
        force: None,
        tangents: Some(&mut tangents),
    };
    let mut found = Vec::new();
    integrator
        .simulate(
            &[0.0, 0.0],
            &samples(),
            &base(),
            options,
            &mut |_, state, tangents| {
                found.push((state.to_vec(), tangents.expect("tangents").vectors[0]));
            },
        )
        .expect("a motion");
    for (t, (state, tangent)) in samples().iter().zip(found) {
        let index = t.powi(3) - 6.0 / 9.0 * t + 6.0 / 27.0 * (3.0 * t).sin();
        assert_eq!(state.len(), 2);
        assert!((state[0] - index).abs() < 1e-11, "{t}: {state:?}");
        assert!((tangent - (3.0 * t).cos()).abs() < 1e-11, "{t}: {tangent}");
    }
}

#[test]
fn friction_on_the_base_holds_until_its_acceleration_exceeds_the_bound() {
    let mut integrator = integrator("-F*sign(dot(x) - dot(s))", &[1.0, 9.0, 3.0]);
    let options = Options {
        force: None,
        tangents: None,
    };
    let mut found = Vec::new();
    integrator
        .simulate(
            &[0.0, 0.0],
            &samples(),
            &base(),
            options,
            &mut |_, state, _| {
                found.push(state[0]);
            },
        )
        .expect("a motion");
    // The base accelerates by 6 t.
    let slip = 0.5;
    for (t, index) in samples().iter().zip(found) {
        let after = f64::max(t - slip, 0.0);
        let held = f64::min(*t, slip).powi(3);
        let wanted = held + 3.0 * slip * slip * after + 1.5 * after * after;
        assert!((index - wanted).abs() < 1e-5, "{t}: {index} {wanted}");
    }
}
