//! Tests of the oracle against textbook equations, and against equivalent specifications.

use super::super::sampler::Sampler;
use super::super::test_models::{BEAM, DOUBLE_PENDULUM, SPRING, model};
use super::{Equations, Oracle, OracleError, Side};
use eomgen_model_spec::ids::{CoordinateId, FieldId, InputId};
use eomgen_model_spec::model::{Expr, ExprKind};
use eomgen_model_spec::span::Span;

fn oracle(text: &str, order: usize) -> Oracle {
    let model = model(text);
    let parameters = model.parameter_values().unwrap();
    Oracle::new(&model, order, &parameters).unwrap()
}

fn accelerations(oracle: &Oracle, time: f64, state: &[f64], inputs: &[f64]) -> Vec<f64> {
    let equations = oracle.equations(time, state, inputs).unwrap();
    equations.accelerations().unwrap().as_slice().to_vec()
}

fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (left, right) in found.iter().zip(expected) {
        let scale = right.abs().max(1e-300);
        assert!(
            (left - right).abs() <= tolerance * scale,
            "{found:?} {expected:?}"
        );
    }
}

#[test]
fn spring_with_play_has_three_regimes() {
    let oracle = oracle(SPRING, 0);
    let found = |y, rate| accelerations(&oracle, 0.0, &[y, rate], &[4.0]);
    // m y'' = u - k f_k(y) - c f_c(y).
    assert_close(
        &found(0.03, 0.5),
        &[(4.0 - 300.0 * 0.02 - 2.5) / 2.0],
        1e-14,
    );
    assert_close(
        &found(-0.03, 0.5),
        &[(4.0 + 300.0 * 0.02 - 2.5) / 2.0],
        1e-14,
    );
    assert_close(&found(0.005, 0.5), &[2.0], 1e-14);
    let sides = |y| oracle.switch_values(0.0, &[y, 0.0], &[0.0]).unwrap()[0].side();
    assert_eq!(oracle.switches().len(), 1);
    assert_eq!(
        [sides(-0.02), sides(0.01), sides(0.02)],
        [Side::Minus, Side::Free, Side::Plus]
    );
}

fn double_pendulum(state: &[f64]) -> Vec<f64> {
    let (m_1, m_2, l_1, l_2, g, c) = (1.3, 0.7, 0.9, 0.6, 9.81, 0.2);
    let (difference, rate) = (state[0] - state[1], state[3] - state[2]);
    let (m_11, m_22) = ((m_1 + m_2) * l_1 * l_1, m_2 * l_2 * l_2);
    let m_12 = m_2 * l_1 * l_2 * difference.cos();
    let f_1 = -m_2 * l_1 * l_2 * state[3].powi(2) * difference.sin()
        - (m_1 + m_2) * g * l_1 * state[0].sin()
        + c * rate;
    let f_2 = m_2 * l_1 * l_2 * state[2].powi(2) * difference.sin()
        - m_2 * g * l_2 * state[1].sin()
        - c * rate;
    let determinant = m_11 * m_22 - m_12 * m_12;
    vec![
        (m_22 * f_1 - m_12 * f_2) / determinant,
        (m_11 * f_2 - m_12 * f_1) / determinant,
    ]
}

#[test]
fn double_pendulum_matches_textbook() {
    let oracle = oracle(DOUBLE_PENDULUM, 0);
    let mut sampler = Sampler::new(&oracle, 7).unwrap();
    for _ in 0..100 {
        let sample = sampler.draw();
        let equations = oracle.equations(0.0, &sample.state, &[]).unwrap();
        let expected = double_pendulum(&sample.state);
        assert!(equations.worst_residual(&expected) < 1e-14);
        let mut wrong = expected.clone();
        wrong[1] *= 1.0 + 1e-9;
        assert!(equations.worst_residual(&wrong) > 1e-12);
    }
}

#[test]
fn moved_support_accelerates_pendulum() {
    let text = r#"
[model]
name = "moved"
title = "Pendulum with a moved support"

[parameters]
m = { value = 1.0, unit = "kg", doc = "mass" }
l = { value = 0.5, unit = "m", doc = "rod" }
a = { value = 0.1, unit = "m", doc = "amplitude" }
omega = { value = 30.0, unit = "rad/s", doc = "frequency" }
g = { value = 9.81, unit = "m/s^2", doc = "gravity" }

[coordinates]
theta = { unit = "rad", doc = "angle" }

[definitions]
across = "l*sin(theta)"
up = "a*sin(omega*t) - l*cos(theta)"

[kinetic]
mass = "1/2*m*(dot(across)^2 + dot(up)^2)"

[potential]
gravity = "m*g*up"
"#;
    let oracle = oracle(text, 0);
    let (time, angle): (f64, f64) = (0.37, 0.8);
    let support = -0.1 * 30.0 * 30.0 * (30.0 * time).sin();
    let expected = -(9.81 + support) / 0.5 * angle.sin();
    assert_close(
        &accelerations(&oracle, time, &[angle, 2.0], &[]),
        &[expected],
        1e-13,
    );
    assert!(!oracle.is_scleronomic(time, &[angle, 2.0], &[]).unwrap());
}

#[test]
fn force_on_definition_does_virtual_work() {
    let text =
        DOUBLE_PENDULUM.to_owned() + "\n[forces]\nside = { on = \"x_2\", value = \"3*m_2*g\" }\n";
    let (with, without) = (oracle(&text, 0), oracle(DOUBLE_PENDULUM, 0));
    let state = [0.4, -1.1, 0.7, 1.9];
    let force = 3.0 * 0.7 * 9.81;
    let right = |oracle: &Oracle| oracle.equations(0.0, &state, &[]).unwrap().right_side();
    let added = right(&with) - right(&without);
    let (arm_1, arm_2) = (0.9 * state[0].cos(), 0.6 * state[1].cos());
    assert_close(added.as_slice(), &[force * arm_1, force * arm_2], 1e-13);
    let joint = -0.2 * (state[3] - state[2]).powi(2);
    let expected = force * (arm_1 * state[2] + arm_2 * state[3]) + joint;
    assert_close(
        &[with.power(0.0, &state, &[]).unwrap().value],
        &[expected],
        1e-13,
    );
}

#[test]
fn cantilever_frequencies_match_formula_up_to_mode_64() {
    let text = BEAM.replace(
        "hub = \"1/2*J*dot(theta)^2\"",
        "hub = \"1e9*J*dot(theta)^2\"",
    );
    let oracle = oracle(&text.replace("value = 0.3", "value = 0.0"), 64);
    let (stiffness, mass) = (7e10 * 1.5e-9, 2700.0 * 2e-4);
    for (r, root) in [
        (1, 1.875_104_068_711_961_2),
        (64, 63.5 * std::f64::consts::PI),
    ] {
        let mut state = vec![0.0; 2 * oracle.size()];
        state[r] = 1e-3;
        let equations = oracle.equations(0.0, &state, &[0.0]).unwrap();
        let found = -equations.right_side()[r] / equations.mass[(r, r)] / 1e-3;
        let beta: f64 = root / 1.25;
        // beta^4 has eight roundings, the quadrature fewer than twenty.
        assert_close(&[found], &[stiffness / mass * beta.powi(4)], 1e-14);
    }
}

/// Returns the largest difference of two sets of equations, relative to each row's scale.
fn distance(left: &Equations, right: &Equations) -> f64 {
    let solution = left.accelerations().unwrap();
    right.worst_residual(solution.as_slice())
}

#[test]
fn cached_derivatives_match_plain_sum_over_places() {
    let kept = oracle(BEAM, 5);
    // A nested sum of value zero prevents the caching of the integral's derivatives.
    let nested = BEAM.replace(
        "x*dot(theta) + dot(w))^2",
        "x*dot(theta) + dot(w))^2 + 0*dot(tip)^2*rho*A",
    );
    let plain = oracle(&nested, 5);
    let mut sampler = Sampler::new(&kept, 3).unwrap();
    for _ in 0..10 {
        let sample = sampler.draw();
        let at = |oracle: &Oracle| {
            oracle
                .equations(0.0, &sample.state, &sample.inputs)
                .unwrap()
        };
        assert!(distance(&at(&kept), &at(&plain)) < 1e-14);
    }
}

#[test]
fn sums_over_modes_match_integrals_over_field() {
    let integral = oracle(BEAM, 4);
    let sums = BEAM
        .replace(
            "1/2*integral(rho*A*(x*dot(theta) + dot(w))^2, w)",
            "1/2*rho*A*(l^3/3*dot(theta)^2 \
             + 2*dot(theta)*sum(i, w, integral(x*phi[i], w)*dot(q[i])) \
             + sum(i, w, integral(phi[i]^2, w)*dot(q[i])^2))",
        )
        .replace(
            "1/2*integral(E*I*diff(w, x, 2)^2, w)",
            "1/2*E*I*sum(i, w, integral(diff(phi[i], x, 2)^2, w)*q[i]^2)",
        );
    let sums = oracle(&sums, 4);
    let mut sampler = Sampler::new(&integral, 3).unwrap();
    for _ in 0..10 {
        let sample = sampler.draw();
        let at = |oracle: &Oracle| {
            oracle
                .equations(0.0, &sample.state, &sample.inputs)
                .unwrap()
        };
        assert!(distance(&at(&integral), &at(&sums)) < 1e-13);
    }
}

#[test]
fn energy_rate_equals_power_of_forces() {
    for (text, order) in [(SPRING, 0), (DOUBLE_PENDULUM, 0), (BEAM, 6)] {
        let oracle = oracle(text, order);
        let mut sampler = Sampler::new(&oracle, 11).unwrap();
        for _ in 0..20 {
            let sample = sampler.draw();
            let (state, inputs) = (&sample.state, &sample.inputs);
            let found = accelerations(&oracle, sample.time, state, inputs);
            let rate = oracle
                .energy_rate(sample.time, state, &found, inputs)
                .unwrap();
            let power = oracle.power(sample.time, state, inputs).unwrap();
            assert!(oracle.is_scleronomic(sample.time, state, inputs).unwrap());
            assert!((rate.value - power.value).abs() < 1e-13 * rate.magnitude.max(power.magnitude));
        }
    }
}

#[test]
fn order_zero_gives_rigid_beam() {
    let oracle = oracle(BEAM, 0);
    let mass = oracle.equations(0.0, &[0.1, 0.2], &[0.0]).unwrap().mass;
    let l: f64 = 1.25;
    let expected = 0.4 + 2700.0 * 2e-4 * l.powi(3) / 3.0 + 0.3 * l * l;
    assert_close(mass.as_slice(), &[expected], 1e-14);
}

/// A checked model excludes these expressions, but the oracle must not depend on that.
#[test]
fn unsupported_expressions_are_rejected() {
    let refuse = |expression: &Expr| {
        let mut model = model(SPRING);
        model.kinetic[0].value = expression.clone();
        let parameters = model.parameter_values().unwrap();
        Oracle::new(&model, 0, &parameters).map(drop).unwrap_err()
    };
    let of = |kind| Expr {
        kind,
        span: Span::default(),
    };
    let input = of(ExprKind::Input(InputId::new(0)));
    assert_eq!(refuse(&input), OracleError::InputRate("mass".into()));
    let rate = of(ExprKind::Dot(input.into()));
    assert_eq!(refuse(&rate), OracleError::InputRate("mass".into()));
    let rate = of(ExprKind::Dot(
        of(ExprKind::Coordinate(CoordinateId::new(0))).into(),
    ));
    let acceleration = of(ExprKind::Dot(rate.into()));
    assert_eq!(
        refuse(&acceleration),
        OracleError::Acceleration("mass".into())
    );
    let field = of(ExprKind::Field(FieldId::new(0)));
    assert_eq!(refuse(&field), OracleError::Misplaced("mass".into()));
}

#[test]
fn wrong_lengths_are_rejected() {
    let model = model(SPRING);
    let short = Oracle::new(&model, 0, &[1.0]);
    assert!(matches!(short, Err(OracleError::Length { .. })));
    let oracle = oracle(SPRING, 0);
    for (state, inputs) in [(&[0.0][..], &[0.0][..]), (&[0.0; 2], &[])] {
        let found = oracle.equations(0.0, state, inputs);
        assert!(matches!(found, Err(OracleError::Length { .. })));
    }
}
