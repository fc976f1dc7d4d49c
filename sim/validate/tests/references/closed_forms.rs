//! Tests of the closed forms of the other machines: conservation of energy, textbook limits, errors.

use eomgen_validate::references::closed_forms::{CLOSED_FORMS, NotApplicable, StateAndParameters};
use eomgen_validate::references::evaluation::Evaluation;
use eomgen_validate::references::planetary_arm::mode_shapes::ModeShape;
use proptest::prelude::*;

type Values = &'static [(&'static str, f64)];

const DOUBLE: Values = &[
    ("m_1", 1.3),
    ("m_2", 0.7),
    ("l_1", 0.9),
    ("l_2", 0.6),
    ("g", 9.81),
];
const CART: Values = &[
    ("M", 2.0),
    ("m_1", 0.4),
    ("m_2", 0.3),
    ("l_1", 0.8),
    ("l_2", 0.5),
    ("g", 9.81),
];
const FURUTA: Values = &[
    ("J_a", 0.02),
    ("L", 0.3),
    ("m", 0.15),
    ("l", 0.2),
    ("J", 1e-3),
    ("g", 9.81),
];
const BEAM: Values = &[
    ("J_h", 0.4),
    ("rho", 2700.0),
    ("A", 2e-4),
    ("E", 7e10),
    ("I", 1.5e-9),
    ("l", 1.25),
    ("M_t", 0.3),
    ("J_t", 0.01),
];

fn look_up(values: Values) -> impl Fn(&str) -> Option<f64> {
    move |name| {
        values
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, value)| *value)
    }
}

fn evaluate(
    model: &str,
    values: Values,
    order: usize,
    state: &[f64],
) -> Result<Evaluation, NotApplicable> {
    let mut known = CLOSED_FORMS.iter();
    let (_, closed_form) = known
        .find(|(shipped, _)| shipped.name == model)
        .expect("a known model");
    let parameter = look_up(values);
    closed_form(&StateAndParameters {
        parameter: &parameter,
        input: &|_| None,
        order,
        state,
    })
}

/// Returns the terms of T + V of each machine, from positions and velocities of its parts.
fn energies(model: &str, values: Values, order: usize, state: &[f64]) -> Vec<f64> {
    let parameter = look_up(values);
    let p = |name: &str| parameter(name).unwrap_or_else(|| panic!("{name} is missing"));
    let (q, v) = state.split_at(state.len() / 2);
    match model {
        "double_pendulum" => {
            let upper = [p("l_1") * q[0].cos() * v[0], p("l_1") * q[0].sin() * v[0]];
            let lower = [
                upper[0] + p("l_2") * q[1].cos() * v[1],
                upper[1] + p("l_2") * q[1].sin() * v[1],
            ];
            let height = -p("l_1") * q[0].cos();
            vec![
                p("m_1") * 0.5 * square(&upper),
                p("m_1") * p("g") * height,
                p("m_2") * 0.5 * square(&lower),
                p("m_2") * p("g") * height,
                -p("m_2") * p("g") * p("l_2") * q[1].cos(),
            ]
        }
        "cart_two_arms" => {
            let arm = |m: f64, l: f64, i: usize| {
                let velocity = [v[0] + l * q[i].cos() * v[i], l * q[i].sin() * v[i]];
                [m * 0.5 * square(&velocity), -m * p("g") * l * q[i].cos()]
            };
            let cart = [0.5 * p("M") * v[0] * v[0]];
            let arms = [arm(p("m_1"), p("l_1"), 1), arm(p("m_2"), p("l_2"), 2)];
            cart.into_iter().chain(arms.into_iter().flatten()).collect()
        }
        "furuta_pendulum" => {
            // Components along the arm, perpendicular to it, and upward.
            let velocity = [
                -p("l") * q[1].sin() * v[0],
                p("L") * v[0] + p("l") * q[1].cos() * v[1],
                p("l") * q[1].sin() * v[1],
            ];
            let turning = v[1] * v[1] + (q[1].sin() * v[0]).powi(2);
            vec![
                0.5 * p("J_a") * v[0] * v[0],
                0.5 * p("m") * square(&velocity),
                0.5 * p("J") * turning,
                -p("m") * p("g") * p("l") * q[1].cos(),
            ]
        }
        _ => vec![beam_energy(&p, order, q, v)],
    }
}

fn beam_energy(p: &dyn Fn(&str) -> f64, order: usize, q: &[f64], v: &[f64]) -> f64 {
    let l = p("l");
    let shapes: Vec<ModeShape> = (1..=order).map(ModeShape::clamped_free).collect();
    let field = |coordinates: &[f64], derivative: u32, s: f64| -> f64 {
        let modes = shapes.iter().zip(&coordinates[1..]);
        modes
            .map(|(shape, q)| shape.derivative(derivative, s) * q)
            .sum()
    };
    // Simpson's rule with panels that resolve four modes.
    let panels = 400;
    let mut sum = 0.0;
    for node in 0..=2 * panels {
        let s = f64::from(node) / f64::from(2 * panels);
        let weight = match node {
            0 => 1.0,
            n if n == 2 * panels => 1.0,
            n if n % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let velocity = s * l * v[0] + field(v, 0, s);
        let curvature = field(q, 2, s) / (l * l);
        let density =
            p("rho") * p("A") * velocity * velocity + p("E") * p("I") * curvature * curvature;
        sum += weight * density;
    }
    let tip = l * v[0] + field(v, 0, 1.0);
    let turn = v[0] + field(v, 1, 1.0) / l;
    0.5 * sum * l / f64::from(6 * panels)
        + 0.5 * (p("J_h") * v[0] * v[0] + p("M_t") * tip * tip + p("J_t") * turn * turn)
}

fn square(vector: &[f64]) -> f64 {
    vector.iter().map(|component| component * component).sum()
}

/// Computes d(energy)/dt along the motion by central differences, and its scale.
fn power(model: &str, values: Values, order: usize, state: &[f64]) -> (f64, f64) {
    let accelerations = evaluate(model, values, order, state)
        .expect("a value")
        .accelerations;
    let half = state.len() / 2;
    let direction: Vec<f64> = state[half..].iter().copied().chain(accelerations).collect();
    let size = direction
        .iter()
        .fold(1.0_f64, |largest, rate| largest.max(rate.abs()));
    let step = 1e-5 / size;
    let at = |sign: f64| {
        let moved: Vec<f64> = state
            .iter()
            .zip(&direction)
            .map(|(y, rate)| y + sign * step * rate)
            .collect();
        energies(model, values, order, &moved)
    };
    let (ahead, behind) = (at(1.0), at(-1.0));
    let total = |terms: &[f64]| terms.iter().sum::<f64>();
    // The terms may cancel, but their rounding errors do not.
    let magnitude = |terms: &[f64]| terms.iter().map(|term| term.abs()).sum::<f64>();
    (
        (total(&ahead) - total(&behind)) / (2.0 * step),
        (magnitude(&ahead) + magnitude(&behind)) / step,
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The energies use positions and velocities of the parts. Without damping and input the closed
    /// forms must conserve them.
    #[test]
    fn free_machines_conserve_energy(numbers in proptest::collection::vec(-2.0..2.0_f64, 10)) {
        let cases = [
            ("double_pendulum", DOUBLE, 0, 4),
            ("cart_two_arms", CART, 0, 6),
            ("furuta_pendulum", FURUTA, 0, 4),
            ("hub_beam_tip_mass", BEAM, 4, 10),
        ];
        for (model, values, order, entries) in cases {
            let mut state = numbers[..entries].to_vec();
            // Deflections are scaled to millimetres.
            state[1..=order].iter_mut().enumerate().for_each(|(i, q)| *q *= 1e-2 / (i + 1).pow(4) as f64);
            let (power, scale) = power(model, values, order, &state);
            // Rounding error of the difference quotient: about a hundred operations for each energy.
            prop_assert!(power.abs() < 4e-13 * scale, "{model}: {power:e} of {scale:e}");
        }
    }
}

#[test]
fn pendulum_swings_down_with_damping() {
    let values: Values = &[("m", 2.0), ("a", 0.5), ("I", 0.1), ("g", 9.81), ("k", 0.1)];
    let found = evaluate("pendulum", values, 0, &[std::f64::consts::PI + 0.3, 2.0])
        .expect("a value")
        .accelerations;
    let expected = (-2.0 * 9.81 * 0.5 * 0.3_f64.sin() - 0.1 * 2.0) / 0.6;
    // The tolerance allows for the rounding of the argument pi + 0.3 of the sine, half a unit in the last place of 3.4.
    assert!((found[0] - expected).abs() < 1e-14 * expected.abs());
}

#[test]
fn friction_opposes_the_motion_of_the_axis() {
    let values: Values = &[("M", 95.0), ("F_v", 200.0), ("F_c", 20.0), ("offset", -3.0)];
    let at = |rate: f64| {
        evaluate("emps", values, 0, &[0.1, rate])
            .expect("a value")
            .accelerations[0]
    };
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-15, "{found}");
    close(at(0.0), 3.0 / 95.0);
    close(at(0.1), (-20.0 - 20.0 + 3.0) / 95.0);
    close(at(-0.1), (20.0 + 20.0 + 3.0) / 95.0);
}

#[test]
fn missing_parameters_are_named() {
    let error = evaluate("pendulum", &[("m", 1.0), ("a", 1.0)], 0, &[0.0, 0.0]);
    assert_eq!(error, Err(NotApplicable::Parameter("g")));
    let error = evaluate("double_pendulum", DOUBLE, 0, &[0.0; 3]);
    assert_eq!(error, Err(NotApplicable::State(4)));
    let error = evaluate("hub_beam_tip_mass", BEAM, 2, &[0.0; 4]);
    assert_eq!(error, Err(NotApplicable::State(6)));
}
