//! Comparison of the feedback of single modes with the rates of the machine without feedback.

use eomgen_codegen::program::evaluator::Point;
use eomgen_compiled_model::{CompiledModel, Orders};
use eomgen_tests::certified::{certify, check_model};

const MACHINE: &str = r#"
[model]
name = "hub"
title = "Hub with a beam and modal feedback"
[parameters]
J = { value = 0.05, unit = "kg m^2" }
m = { value = 0.243, unit = "kg/m" }
l = { value = 0.8, unit = "m" }
EI = { value = 4.7, unit = "N m^2" }
K_q = { value = 2.5, unit = "N" }
K_v = { value = 0.7, unit = "N s" }
[coordinates]
psi = { unit = "rad" }
theta = { unit = "rad" }
[fields.w]
along = "x"
from = 0
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 3
unit = "m"
[definitions]
measured = "q_2"
[kinetic]
motor = "1/2*J*dot(psi)^2"
hub = "1/2*J*dot(theta)^2"
beam = "1/2*integral(m*(x*dot(theta) + dot(w))^2, w)"
[potential]
bending = "1/2*integral(EI*diff(w, x, 2)^2, w)"
[forces]
feedback = { on = "psi", value = "-K_q*measured - K_v*dot(q_3)" }
[observables]
second = "q_2"
"#;

#[test]
fn modal_feedback_adds_the_force_of_the_named_modes() {
    let model = CompiledModel::from_text("hub.toml", MACHINE, Orders::Uniform(4)).expect("a model");
    let state: Vec<f64> = (0..12).map(|k| 0.1 + 0.07 * f64::from(k)).collect();
    let rates = |settings: &[(&str, f64)]| {
        let instance = model.with_parameters(settings).expect("parameters");
        let mut rates = vec![0.0; 12];
        let point = Point {
            t: 0.0,
            state: &state,
            inputs: &[],
        };
        instance
            .evaluator()
            .expect("an evaluator")
            .rates(point, &mut rates);
        rates
    };
    let with = rates(&[]);
    let without = rates(&[("K_q", 0.0), ("K_v", 0.0)]);
    // The motor has its own equation: J psi_ddot = -K_q q_2 - K_v q_3_dot.
    let names = model.state_names();
    let value = |name: &str| {
        let place = names.iter().position(|known| known == name);
        state[place.expect("a state")]
    };
    let added = -(2.5 * value("q_2") + 0.7 * value("q_3_dot")) / 0.05;
    for (name, (with, without)) in names.iter().zip(with.iter().zip(&without)) {
        let expected = if name == "psi_dot" { added } else { 0.0 };
        assert!(
            (with - without - expected).abs() <= 1e-13 * added.abs(),
            "{name}"
        );
    }
}

#[test]
fn feedback_of_a_mode_is_certified_at_orders_with_this_mode() {
    for order in [3, 4] {
        let model = check_model(&MACHINE.replace("order = 3", &format!("order = {order}")));
        let certificate = certify(&model, &model);
        let failures: Vec<_> = certificate.failures().collect();
        assert!(failures.is_empty(), "{order}: {failures:?}");
    }
}

#[test]
fn order_without_the_measured_mode_is_rejected() {
    let derived = CompiledModel::from_text("hub.toml", MACHINE, Orders::Uniform(2));
    let failure = derived.err().expect("order 2 has no third mode");
    let message = failure.to_string();
    assert!(
        message.contains("there is no mode 3 of `w` at order 2"),
        "{message}"
    );
}
