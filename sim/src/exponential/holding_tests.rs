//! Motions that dry friction holds beside forces that differ by the direction of motion.

use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;

use crate::inputs::HeldInputs;
use crate::piecewise_linear::PiecewiseLinear;

use super::{ExponentialIntegrator, Options, UnsupportedModel};

/// Time between samples, s.
const SAMPLE: f64 = 0.01;

/// Mass in kg, friction in N, damping in N s/m and length in m.
const VALUES: [f64; 4] = [2.0, 3.0, 4.0, 0.5];

/// A mass of 2 kg with an input force and this friction, in which T = 3 N and c = 4 N s/m.
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
    ExponentialIntegrator::new(exact.evaluator(&VALUES), SAMPLE, 1.0)
}

#[test]
fn friction_holds_beside_damping_that_differs_by_direction() {
    let times: Vec<f64> = (0..=200).map(|k| f64::from(k) * SAMPLE).collect();
    let changes = vec![0.0, 0.3, 0.8, 1.2, 1.5];
    let inputs = HeldInputs::new(changes, vec![8.0, -1.0, -7.0, 2.0, 6.0], 1).expect("inputs");
    for friction in [
        "-T*sign(dot(x)) - c*abs(dot(x))",
        "-T*sign(dot(x)) - c*max(dot(x), 0)",
        "-T*sign(dot(x)) + c*min(dot(x), 0)",
        "-T*sign(dot(x)) - c*dot(x)*above(dot(x))",
        "-T*above(dot(x)) - c*dot(x)*sign(dot(x))",
    ] {
        let exact = PiecewiseLinear::derive(&block(friction), &[]).expect("piecewise linear");
        let mut propagator = exact.propagator_at(&VALUES).expect("a propagator");
        let expected = propagator
            .simulate(&[0.0, 0.0], (0.0, 2.0), &times, &inputs, &mut |_| {})
            .expect("a motion");
        let mut states = Vec::new();
        let options = Options {
            force: None,
            tangents: None,
        };
        integrator(friction)
            .expect("can be integrated")
            .simulate(&[0.0, 0.0], &times, &inputs, options, &mut |_, state, _| {
                states.push(state.to_vec());
            })
            .expect("a motion");
        for (t, (found, expected)) in times.iter().zip(states.iter().zip(&expected.states)) {
            let difference = (found[0] - expected[0]).abs();
            assert!(difference < 1e-9, "{friction} at {t} s: {difference:e}");
        }
    }
}

/// The share of such a force that holds the motion is not linear in the state and the inputs.
#[test]
fn holding_forces_that_depend_on_state_or_input_are_rejected() {
    for friction in [
        "-0.1*u*sign(dot(x))",
        "-(T + 0.1*u)*sign(dot(x)) - c*abs(dot(x))",
        "-(T + T*x/l)*sign(dot(x))",
    ] {
        let found = integrator(friction).err();
        assert_eq!(
            found,
            Some(UnsupportedModel::VaryingHoldingForces),
            "{friction}"
        );
    }
}
