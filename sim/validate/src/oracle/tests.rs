//! Tests of the oracle against textbook equations, and against equivalent specifications.

use super::super::sampler::Sampler;
use super::super::test_models::{BEAM, DOUBLE_PENDULUM, SPRING, parse_model};
use super::{Equations, Oracle, OracleError, Side};
use eomgen_model_spec::ids::{CoordinateId, FieldId, InputId};
use eomgen_model_spec::model::{Expr, ExprKind};
use eomgen_model_spec::span::Span;

fn oracle(text: &str, order: usize) -> Oracle {
    let model = parse_model(text);
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
        // The tolerance allows for eight roundings of beta^4 and fewer than twenty of the quadrature.
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
    // A nested sum with the value zero prevents the caching of the integral's derivatives.
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

/// The model checker rejects these expressions too, but the oracle must not depend on it.
#[test]
fn unsupported_expressions_are_rejected() {
    let refuse = |expression: &Expr| {
        let mut model = parse_model(SPRING);
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
    assert_eq!(refuse(&field), OracleError::MisplacedField("mass".into()));
}

#[test]
fn wrong_lengths_are_rejected() {
    let model = parse_model(SPRING);
    let short = Oracle::new(&model, 0, &[1.0]);
    assert!(matches!(short, Err(OracleError::WrongLength { .. })));
    let oracle = oracle(SPRING, 0);
    for (state, inputs) in [(&[0.0][..], &[0.0][..]), (&[0.0; 2], &[])] {
        let found = oracle.equations(0.0, state, inputs);
        assert!(matches!(found, Err(OracleError::WrongLength { .. })));
    }
}

/// Powers of clipped expressions, for example max(p, 0)^n, are zero with all derivatives on the flat side.
#[test]
fn powers_of_clipped_expressions_have_forces_on_both_sides() {
    // The potential, and minus its derivative by y at y = 0.25 with k = 300, b = 0.01.
    let root = |y: f64| y.sqrt();
    for (potential, force) in [
        ("1/2.5*k*b^-0.5*max(y, 0)^2.5", -3000.0 * 0.25_f64.powf(1.5)),
        ("1/1.5*k*b^0.5*max(y, 0)^1.5", -30.0 * root(0.25)),
        ("k*b^1.5*sqrt(max(y, 0))", -300.0 * 1e-3 * 0.5 / root(0.25)),
        (
            "k*b^2*(max(y, 0)/b)^0.3",
            -300.0 * 1e-2 * 0.3 * 25.0_f64.powf(-0.7),
        ),
        (
            "k*b^2*(max(deadzone(y, b), 0)/b)^1.5",
            -300.0 * 1e-2 * 1.5 * root(24.0),
        ),
        (
            "k*b^2*(-min(0, -y)/b)^1.5",
            -300.0 * 1e-2 * 1.5 * root(25.0),
        ),
    ] {
        let text = SPRING.replace("1/2*k*deadzone(y, b)^2", potential);
        let oracle = oracle(&text, 0);
        let found = |y: f64| accelerations(&oracle, 0.0, &[y, 0.0], &[0.0]);
        assert_close(&found(0.25), &[force / 2.0], 1e-13);
        assert_eq!(found(-0.25), [0.0], "{potential}");
    }
}

/// Forces with clipped powers of a rate, and with an exponent that depends on the motion.
#[test]
fn forces_with_clipped_powers_are_numbers_on_both_sides() {
    for (force, expected) in [
        (
            "-c*b^-0.5*max(y, 0)^1.5/t_0",
            -5.0 * 10.0 * 0.25_f64.powf(1.5),
        ),
        (
            "-c*b/t_0*(max(y, 0)/b)^(1 + y^2/(1000*b^2))",
            -5.0 * 0.01 * 25.0_f64.powf(1.625),
        ),
        ("-c*b/t_0*sqrt(max(y/b, 0))", -5.0 * 0.01 * 5.0),
    ] {
        let text = SPRING.replace("-c*contact(y, b)*dot(y)", force).replace(
            "[coordinates]",
            "t_0 = { value = 1, unit = \"s\" }\n[coordinates]",
        );
        let oracle = oracle(&text, 0);
        let found = |y: f64| accelerations(&oracle, 0.0, &[y, 0.0], &[0.0]);
        let spring = 300.0 * 0.24;
        assert_close(&found(0.25), &[(expected - spring) / 2.0], 1e-12);
        assert_close(&found(-0.25), &[spring / 2.0], 1e-14);
    }
}

/// The integrand of a field's energy contains a clipped power.
#[test]
fn field_energy_with_clipped_power_is_finite_where_the_field_is_clipped() {
    let text = BEAM.replace(
        "1/2*integral(E*I*diff(w, x, 2)^2, w)",
        "1/2*integral(E*I*diff(w, x, 2)^2 + E*A*(max(w, 0)/l)^2.5, w)",
    );
    let (clipped, plain) = (oracle(&text, 1), oracle(BEAM, 1));
    let found = |oracle: &Oracle, q: f64| accelerations(oracle, 0.0, &[0.0, q, 0.0, 0.0], &[0.0]);
    // The first mode of a clamped beam has one sign.
    let sides = [1e-3, -1e-3].map(|q| {
        let (with, without) = (found(&clipped, q), found(&plain, q));
        assert!(with.iter().all(|number| number.is_finite()), "{with:?}");
        let pairs = with.iter().zip(&without);
        let differs = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-6 * b.abs();
        pairs.filter(|(a, b)| differs((*a, *b))).count()
    });
    assert_eq!(
        sides.iter().filter(|count| **count == 0).count(),
        1,
        "{sides:?}"
    );
}

/// The range is closed. A regime beyond a switching surface at its end is empty.
#[test]
fn regimes_beyond_a_surface_at_the_end_of_a_range_are_empty() {
    for (range, force, sides) in [
        (
            "[0, 1], initial = 0.5",
            "-c*max(dot(y), 0)*above(y)",
            vec![Side::Plus],
        ),
        (
            "[-1, 0], initial = -0.5",
            "-c*abs(y)/t_0",
            vec![Side::Minus],
        ),
        (
            "[\"3*b\", 1], initial = 0.5",
            "-c*max(y, 3*b)/t_0",
            vec![Side::Plus],
        ),
        ("[\"-b\", \"b\"]", "-c*deadzone(y, b)/t_0", vec![Side::Free]),
        (
            "[\"b\", 1], initial = 0.5",
            "-c*deadzone(y, b)/t_0",
            vec![Side::Plus],
        ),
        (
            "[-0.001, 1]",
            "-c*abs(y)/t_0",
            vec![Side::Minus, Side::Plus],
        ),
    ] {
        let text = SPRING
            .replace("1/2*k*deadzone(y, b)^2", "1/2*k*y^2")
            .replace("-c*contact(y, b)*dot(y)", force)
            .replace(
                "y = { unit = \"m\"",
                &format!("y = {{ range = {range}, unit = \"m\""),
            )
            .replace(
                "[coordinates]",
                "t_0 = { value = 1, unit = \"s\" }\n[coordinates]",
            );
        let oracle = oracle(&text, 0);
        let place = oracle.switches().len() - 1;
        let possible: Vec<Side> = [Side::Minus, Side::Plus, Side::Free]
            .into_iter()
            .filter(|side| oracle.switches()[place].sides().contains(side))
            .filter(|side| match place {
                0 => !oracle.is_empty(&[*side], &[1.0, 1.0], &[1.0]),
                _ => !oracle.is_empty(&[Side::Plus, *side], &[1.0, 1.0], &[1.0]),
            })
            .collect();
        assert_eq!(possible, sides, "{range} {force}");
    }
}
