//! Tests of piles that settle on a floor by infinitely many impacts, in several coordinates.

use eomgen_compiled_model::Solver;

use super::{GENERAL, compile_text, simulated};

/// Returns two balls along an axis at the angle `a`; the heavy one presses the light one to a floor. The position of
/// the light ball is `scale` times a coordinate.
fn pile(scale: f64) -> String {
    let light = 0.185 / scale;
    format!(
        r#"
[model]
name = "pile"
[parameters]
m_1 = {{ value = 0.2, unit = "kg" }}
m_2 = {{ value = 6.633, unit = "kg" }}
g = {{ value = 9.81, unit = "m/s^2" }}
b = {{ value = 0.3, unit = "m" }}
a = {{ value = 0, unit = "rad" }}
light = {{ value = {light}, unit = "m" }}
heavy = {{ value = 1.118, unit = "m" }}
fall = {{ value = 0.946, unit = "m/s" }}
[coordinates]
x_1 = {{ unit = "m", initial = "light*cos(a)" }}
y_1 = {{ unit = "m", initial = "light*sin(a)" }}
x_2 = {{ unit = "m", initial = "heavy*cos(a)", initial_rate = "-fall*cos(a)" }}
y_2 = {{ unit = "m", initial = "heavy*sin(a)", initial_rate = "-fall*sin(a)" }}
[definitions]
h_1 = "{scale}*(x_1*cos(a) + y_1*sin(a))"
w_1 = "{scale}*(y_1*cos(a) - x_1*sin(a))"
h_2 = "x_2*cos(a) + y_2*sin(a)"
w_2 = "y_2*cos(a) - x_2*sin(a)"
[kinetic]
k_1 = "1/2*m_1*(dot(h_1)^2 + dot(w_1)^2)"
k_2 = "1/2*m_2*(dot(h_2)^2 + dot(w_2)^2)"
[potential]
weight = "m_2*g*h_2"
[impacts]
balls = {{ when = "h_2 - h_1 - b", restitution = 0.5 }}
floor = {{ when = "h_1 + b", restitution = 0.8 }}
[observables]
h_1 = "h_1"
"#
    )
}

/// Returns the time of the last impact (s) and the last heights of both balls.
fn simulate_settling(scale: f64, angle: f64, solver: Solver) -> (f64, [f64; 2]) {
    let model = compile_text(&pile(scale));
    let motion = simulated(&model, &[("a", angle)], &[0.0, 2.0], solver);
    let state = &motion.trajectory.final_state;
    let (s, c) = angle.sin_cos();
    let heights = [
        scale * (state[0] * c + state[1] * s),
        state[2] * c + state[3] * s,
    ];
    let last = motion.trajectory.events.last().expect("an impact");
    (last.t, heights)
}

#[test]
fn pile_settles_at_the_same_time_in_any_unit_and_at_any_angle() {
    let (end, _) = simulate_settling(1.0, 0.0, Solver::Rk);
    let scales = [0.01, 0.1, 1.0, 3.0, 7.0, 10.0, 100.0, 1e4].map(|scale| (scale, 0.0));
    let angles = [0.2, 0.5, 0.8, 1.1, 2.0, 4.0].map(|angle| (1.0, angle));
    for (scale, angle) in scales.into_iter().chain(angles) {
        for solver in GENERAL {
            let (found, heights) = simulate_settling(scale, angle, solver);
            let case = format!("scale {scale}, angle {angle}, {solver}");
            assert!(
                (found - end).abs() < 1e-9,
                "{case}: {found} instead of {end}"
            );
            for (height, expected) in heights.iter().zip([-0.3, 0.0]) {
                assert!((height - expected).abs() < 1e-9, "{case}: {heights:?}");
            }
        }
    }
}

/// Light ball between a wall and a heavy ball that approaches, without gravity.
const LIGHT_BALL: &str = r#"
[model]
name = "light_ball"
[parameters]
m = { value = 0.126, unit = "kg" }
M = { value = 11.298, unit = "kg" }
e_wall = { value = 0.6, unit = "1" }
e_balls = { value = 0.5, unit = "1" }
[coordinates]
x = { unit = "m", initial = 0.1 }
y = { unit = "m", initial = 0.3, initial_rate = -1 }
[kinetic]
k = "1/2*m*dot(x)^2 + 1/2*M*dot(y)^2"
[impacts]
wall = { when = "x", restitution = "e_wall" }
balls = { when = "y - x", restitution = "e_balls" }
"#;

/// Returns the time (s) at which infinitely many impacts end and the heavy ball rests; `None` if it moves away. The
/// distances are the unknowns, so they can fall far below the rounding errors of positions.
fn find_end_of_impacts(mass_ratio: f64, [wall, balls]: [f64; 2]) -> Option<f64> {
    let (mut t, mut gaps, mut v, mut w) = (0.0, [0.1, 0.2], 0.0, -1.0);
    for _ in 0..20_000 {
        let closing = [-v, v - w];
        let times = [0, 1].map(|place| match closing[place] > 0.0 {
            true => gaps[place] / closing[place],
            false => f64::INFINITY,
        });
        let hit = usize::from(times[1] < times[0]);
        if times[hit].is_infinite() {
            return None;
        }
        t += times[hit];
        gaps = [0, 1].map(|place| gaps[place] - times[hit] * closing[place]);
        gaps[hit] = 0.0;
        if hit == 0 {
            v *= -wall;
        } else {
            let exchanged = (1.0 + balls) * (v - w) / (1.0 + mass_ratio);
            v -= mass_ratio * exchanged;
            w += exchanged;
        }
        if w.abs() < 1e-12 {
            return Some(t);
        }
    }
    None
}

#[test]
fn heavy_ball_stops_at_the_limit_of_the_impacts_of_a_light_one() {
    let model = compile_text(LIGHT_BALL);
    let machines = [
        (0.126, 11.298, 0.6, 0.5),
        (1.0, 50.0, 0.5, 0.5),
        (1.0, 30.0, 0.3, 0.8),
        (1.0, 20.0, 0.5, 0.5),
        (1.0, 100.0, 0.7, 0.7),
        (1.0, 100.0, 0.9, 0.9),
        (2.0, 100.0, 0.2, 0.5),
    ];
    let mut stopped = 0;
    for (light, heavy, wall, balls) in machines {
        let settings = [
            ("m", light),
            ("M", heavy),
            ("e_wall", wall),
            ("e_balls", balls),
        ];
        let Some(end) = find_end_of_impacts(heavy / light, [wall, balls]) else {
            continue;
        };
        stopped += 1;
        for solver in GENERAL {
            let motion = simulated(&model, &settings, &[0.0, 1.0], solver);
            let case = format!("{settings:?} {solver}");
            let last = motion.trajectory.events.last().expect("an impact");
            assert!((last.t - end).abs() < 1e-9, "{case}: {} at {end}", last.t);
            let largest =
                (motion.trajectory.final_state.iter()).fold(0.0, |most: f64, x| most.max(x.abs()));
            assert!(largest < 1e-9, "{case}: {largest}");
        }
    }
    assert!(stopped > 4, "{stopped} machines");
}

/// Four balls; three of them touch at rest.
const TOUCHING_BALLS: &str = r#"
[model]
name = "touching_balls"
[parameters]
d = { value = 0.11, unit = "m" }
o = { value = 0, unit = "m" }
v = { value = 1, unit = "m/s" }
m = { value = 1, unit = "kg" }
[coordinates]
x_0 = { unit = "m", initial = "o - 5*d", initial_rate = "v" }
x_1 = { unit = "m", initial = "o + d" }
x_2 = { unit = "m", initial = "o + 2*d" }
x_3 = { unit = "m", initial = "o + 3*d" }
[kinetic]
k = "1/2*m*(dot(x_0)^2 + dot(x_1)^2 + dot(x_2)^2 + dot(x_3)^2)"
[impacts]
first = { when = "x_1 - x_0 - d", restitution = 0.6 }
second = { when = "x_2 - x_1 - d", restitution = 0.6 }
third = { when = "x_3 - x_2 - d", restitution = 0.6 }
"#;

#[test]
fn balls_that_touch_to_rounding_are_hit_together() {
    let model = compile_text(TOUCHING_BALLS);
    for diameter in [0.1, 0.11, 0.13, 0.3] {
        for origin in [0.0, 0.3, 1.0, -7.7] {
            let settings = [("d", diameter), ("o", origin)];
            let times = [0.0, 8.0 * diameter];
            for solver in GENERAL {
                let motion = simulated(&model, &settings, &times, solver);
                let speeds = &motion.trajectory.final_state[4..];
                for (speed, expected) in speeds.iter().zip([-0.2, 0.4, 0.4, 0.4]) {
                    let case = format!("{settings:?} {solver}: {speeds:?}");
                    assert!((speed - expected).abs() < 1e-9, "{case}");
                }
            }
        }
    }
}
