//! Tests of constrained motions: a pendulum in Cartesian coordinates is compared with the same
//! pendulum described by its angle.

use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::runge_kutta::RungeKutta;

use crate::model::estimation_model::EstimationModel;
use crate::model::longest_step::LongestStep;

const PENDULUM: &str = r#"[model]
name = "pendulum"
[parameters]
m = { value = 0.2, unit = "kg" }
l = { value = 0.3, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
x = { unit = "m" }
y = { unit = "m", initial = "-l" }
[kinetic]
bob = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[constraints]
rod = { zero = "x^2 + y^2 - l^2" }
"#;

const LENGTH: f64 = 0.3;

fn samples() -> Vec<f64> {
    (0..200).map(|k| 5e-3 * f64::from(k)).collect()
}

/// Returns the Cartesian state for an angle and its rate.
fn state_at([angle, rate]: [f64; 2]) -> Vec<f64> {
    let (sin, cos) = angle.sin_cos();
    let speed = LENGTH * rate;
    vec![LENGTH * sin, -LENGTH * cos, speed * cos, speed * sin]
}

/// Integrates the equation of the angle in steps of 50 us; returns the Cartesian states at the
/// samples.
fn integrate_angle(start: [f64; 2]) -> Vec<Vec<f64>> {
    let mut state = start.to_vec();
    let mut method = RungeKutta::new(2);
    let mut found = vec![state_at(start)];
    for _ in 1..samples().len() {
        for _ in 0..100 {
            method.step(&mut state, (0.0, 5e-5), |_, _, state, rates| {
                rates[0] = state[1];
                rates[1] = -9.81 / LENGTH * state[0].sin();
            });
        }
        found.push(state_at([state[0], state[1]]));
    }
    found
}

fn pendulum(is_stepped: bool) -> EstimationModel {
    let model = EstimationModel::derive_equations(PENDULUM, "pendulum", None, &[]);
    let mut model = model.expect("a model");
    model.longest_step = is_stepped.then_some(LongestStep(2.5e-3));
    model
}

#[test]
fn constrained_motion_matches_angle_model_without_drift() {
    let right = integrate_angle([0.9, 0.5]);
    for is_stepped in [true, false] {
        let model = pendulum(is_stepped);
        let mut simulation = model
            .create_simulation(&model.values)
            .expect("a simulation");
        let inputs = HeldInputs::zero(0);
        let mut start = state_at([0.9, 0.5]);
        let found = simulation.simulate_states(&start, &samples(), &inputs);
        for (found, right) in found.expect("states").iter().zip(&right) {
            let differences = found.iter().zip(right).map(|(a, b)| (a - b).abs());
            assert!(
                differences.fold(0.0, f64::max) < 2e-6,
                "{found:?} {right:?}"
            );
            let [x, y, v, w] = found[..] else {
                panic!("{found:?}");
            };
            assert!((x.hypot(y) - LENGTH).abs() < 1e-14 && (x * v + y * w).abs() < 1e-13);
        }
        // An initial state that violates the constraints is projected onto them, here along the
        // rod.
        start.iter_mut().take(2).for_each(|x| *x *= 1.1);
        let moved = simulation.move_onto_constraints(&start, 0.0, &inputs);
        let moved = moved.expect("a state");
        assert!((moved[0] - right[0][0]).hypot(moved[1] - right[0][1]) < 1e-12);
    }
}

#[test]
fn derivatives_along_allowed_directions_match_angle_model() {
    let model = pendulum(true);
    let mut simulation = model
        .create_simulation(&model.values)
        .expect("a simulation");
    let inputs = HeldInputs::zero(0);
    let (start, ranges) = ([0.9, 0.5], [0.1, 0.05, 0.8, 0.4]);
    let state = state_at(start);
    let directions = simulation.find_initial_directions(&state, (0.0, &inputs), &ranges);
    let directions = directions.expect("directions");
    assert_eq!(directions.ncols(), 2);
    let small = 1e-4;
    for direction in directions.column_iter() {
        // Change of angle and rate along the direction.
        let (sin, cos) = f64::sin_cos(start[0]);
        let turn = (cos * direction[0] + sin * direction[1]) / LENGTH;
        let allowed = (sin * direction[0] - cos * direction[1]).abs();
        assert!(allowed < 1e-7 * direction.norm(), "{direction}");
        let faster = (cos * direction[2] + sin * direction[3]) / LENGTH;
        let ends = [small, -small].map(|by| {
            let moved: Vec<f64> = state
                .iter()
                .zip(direction.iter())
                .map(|(x, d)| x + by * d)
                .collect();
            let found = simulation.simulate_states(&moved, &samples(), &inputs);
            let right = integrate_angle([start[0] + by * turn, start[1] + by * faster]);
            (found.expect("states"), right)
        });
        let [(after, right_after), (before, right_before)] = &ends;
        for sample in [0, 50, 199] {
            for entry in 0..4 {
                let own = (after[sample][entry] - before[sample][entry]) / (2.0 * small);
                let right =
                    (right_after[sample][entry] - right_before[sample][entry]) / (2.0 * small);
                let size = direction.norm().max(right.abs());
                assert!(
                    (own - right).abs() < 1e-4 * size,
                    "{sample} {entry}: {own} {right}"
                );
            }
        }
    }
}
