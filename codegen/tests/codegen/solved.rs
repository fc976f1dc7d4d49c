//! Accelerations compared with pivoted elimination of the dense mass matrix, for structures that an earlier version
//! solved incorrectly. Named coefficients compared with differences of the accelerations.

use eomgen_codegen::program::evaluator::{Evaluator, Point};

use crate::support::{accelerations, equations, evaluator, model, program, shipped};

fn beam(kinetic: &str, basis: &str) -> String {
    format!(
        r#"
[model]
name = "beam"
title = "A hub, a beam and a mass"

[parameters]
J  = {{ value = 0.05, unit = "kg m^2" }}
mu = {{ value = 0.25, unit = "kg/m" }}
B  = {{ value = 4.5, unit = "N m^2" }}
l  = {{ value = 0.8, unit = "m" }}
M  = {{ value = 0.4, unit = "kg" }}
n  = {{ value = 10, unit = "1" }}

[coordinates]
theta = {{ unit = "rad" }}

[fields.w]
along = "x"
from = 0
to = "l"
basis = "{basis}"
coordinates = "q"
order = 2
unit = "m"

[kinetic]
hub  = "1/2*J*dot(theta)^2"
all  = "{kinetic}"

[potential]
bending = "1/2*integral(B*diff(w, x, 2)^2, w)"
"#
    )
}

const DISTRIBUTED: &str = "1/2*integral(mu*(x*dot(theta) + dot(w))^2, w)";

/// Returns M a - (f - c) at a state, relative to the largest product in each row.
fn residual(evaluator: &mut Evaluator, state: &[f64]) -> f64 {
    let size = state.len() / 2;
    let point = Point {
        t: 0.0,
        state,
        inputs: &[],
    };
    let (mut mass, mut bias, mut forces) =
        (vec![0.0; size * size], vec![0.0; size], vec![0.0; size]);
    evaluator.mass_matrix(point, &mut mass);
    evaluator.bias_and_forces(point, &mut bias, &mut forces);
    let found = accelerations(evaluator, state);
    (0..size)
        .map(|r| {
            let products: Vec<f64> = (0..size).map(|c| mass[r * size + c] * found[c]).collect();
            let right = forces[r] - bias[r];
            let scale = products
                .iter()
                .fold(right.abs(), |scale, p| scale.max(p.abs()));
            (products.iter().sum::<f64>() - right).abs() / scale
        })
        // f64::max would ignore a NaN.
        .fold(
            0.0,
            |worst, value| if value <= worst { worst } else { value },
        )
}

fn assert_solved(kinetic: &str, basis: &str, orders: &[usize]) {
    let model = model(&beam(kinetic, basis));
    for &order in orders {
        let mut evaluator = evaluator(&model, order);
        assert!(evaluator.pivots_are_positive(), "order {order}: {kinetic}");
        for step in 0..50 {
            let state: Vec<f64> = (0..2 * (order + 1))
                .map(|k| {
                    (0.7 * step as f64 + 1.3 * k as f64).sin() / (1 + k % (order + 1)).pow(3) as f64
                })
                .collect();
            let worst = residual(&mut evaluator, &state);
            // The lever's inertia is up to 1e4 times that of a mode.
            assert!(
                worst < 1e-11,
                "order {order}, step {step}: {worst:e} of {kinetic}"
            );
        }
    }
}

// Two points of the beam move the mass, so the weights are not diagonal. The first minor of I + C G is negative at
// order 2 although M is positive definite.
#[test]
fn mass_on_a_lever_between_two_points_is_solved() {
    for lever in [
        "1/2*M*(at(dot(w), l) + n*at(dot(w), l/2))^2",
        "1/2*M*(cos(theta)*at(dot(w), l) + n*sin(theta)*at(dot(w), l/2))^2",
        "1/2*M*at(dot(w), l)^2 + n*M*at(dot(w), l)*at(dot(w), l/2) + 1/2*M*n^2*at(dot(w), l/2)^2",
    ] {
        assert_solved(
            &format!("{DISTRIBUTED} + {lever}"),
            "clamped_free",
            &[1, 2, 3, 8],
        );
    }
}

// If there are more interfaces than modes, the interfaces are linearly dependent.
#[test]
fn more_interfaces_than_modes_are_solved() {
    let points = "1/2*M*(at(dot(w), l) + n*at(dot(w), l/2) - n*at(dot(w), l/3) + l*at(diff(dot(w), x, 1), l))^2";
    assert_solved(
        &format!("{DISTRIBUTED} + {points}"),
        "clamped_free",
        &[1, 2, 3, 4, 8],
    );
}

// The mode has only the inertia of the tip mass.
#[test]
fn massless_beam_with_tip_mass_is_solved() {
    for tip in ["at(dot(w), l)", "sum(i, w, dot(q[i]))"] {
        assert_solved(
            &format!("1/2*M*(l*dot(theta)/2 + {tip})^2"),
            "clamped_free",
            &[1],
        );
    }
}

// The momenta of all modes are equal.
#[test]
fn mass_that_moves_with_the_sum_of_the_modes_is_solved() {
    for basis in ["clamped_free", "clamped_free_printed"] {
        let sum = "1/2*M*(l*dot(theta)/9 + sum(i, w, dot(q[i])))^2";
        assert_solved(&format!("{DISTRIBUTED} + {sum}"), basis, &[1, 2, 3]);
    }
}

#[test]
fn two_modes_without_separate_inertia_are_rejected() {
    let model = model(&beam(
        "1/2*M*(l*dot(theta)/2 + at(dot(w), l))^2",
        "clamped_free",
    ));
    assert!(!evaluator(&model, 2).pivots_are_positive());
}

// a_1q, a_3q and a_qq of the arm, the factors of q in the accelerations, must equal the difference of two
// evaluations, in either basis. With open meshes at rest the accelerations are linear in q, so only rounding
// errors remain.
#[test]
fn modal_coefficients_match_slopes_of_the_accelerations() {
    for basis in ["clamped_free", "clamped_free_printed"] {
        let arm = shipped("planetary_arm");
        let text = arm
            .source
            .text
            .replace("\"clamped_free\"", &format!("\"{basis}\""));
        slopes_agree(&model(&text), 3);
    }
}

fn slopes_agree(model: &eomgen_model_spec::model::Model, order: usize) {
    let names: Vec<String> = equations(model, order)
        .coefficients
        .iter()
        .map(|c| c.name.clone())
        .collect();
    let mut program = program(model, order);
    program.observable_values = program.coefficient_values.clone();
    let mut evaluator = Evaluator::new(program);
    let size = 3 + order;
    let still = vec![0.0; 2 * size];
    let place = Point {
        t: 0.0,
        state: &still,
        inputs: &[],
    };
    evaluator.observables(place, &mut vec![0.0; names.len()]);
    let coefficient = |name: &str| {
        let index = names.iter().position(|known| known == name).unwrap();
        evaluator
            .slice(evaluator.program().coefficient_values[index])
            .to_vec()
    };
    let (in_x_sp, in_q) = (coefficient("a_1q"), coefficient("a_qq"));
    let (a_30, a_q0, in_x_c) = (
        coefficient("a_30")[0],
        coefficient("a_q0"),
        coefficient("a_3q"),
    );
    let rest = accelerations(&mut evaluator, &still);
    for p in 0..order {
        let mut state = still.clone();
        state[3 + p] = 1.0;
        let moved = accelerations(&mut evaluator, &state);
        let slope = |row: usize| moved[row] - rest[row];
        let close = |found: f64, expected: f64, what: &str| {
            let deviation =
                (found - expected).abs() / moved.iter().fold(1.0_f64, |m, a| m.max(a.abs()));
            assert!(
                deviation < 1e-11,
                "{what}, mode {}: {found} {expected}",
                p + 1
            );
        };
        close(in_x_sp[p], slope(0), "a_1q");
        close(in_x_c[p] / a_30, slope(2), "a_3q");
        for r in 0..order {
            close(in_q[r * order + p] / a_q0[r], slope(3 + r), "a_qq");
        }
    }
}
