//! Friction against the direction of sliding, with a velocity across the motion of any size.

use eomgen_compiled_model::{Motion, Solver};
use eomgen_tests::motions::{grid, simulate_to_end};

/// Deceleration by friction, m/s^2.
const DECELERATION: f64 = 2.0;

/// Returns a body with friction in a plane that starts with the speed 1 m/s along x and `across` along y, and has these
/// further forces.
fn simulate(across: f64, forces: &str, solver: Solver, until: f64) -> Motion {
    let text = format!(
        "[model]\nname = \"puck\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
         F = {{ value = {DECELERATION}, unit = \"N\" }}\nP = {{ value = 3, unit = \"N\" }}\n\
         w = {{ value = 7, unit = \"rad/s\" }}\n[coordinates]\n\
         x = {{ unit = \"m\", initial_rate = 1 }}\ny = {{ unit = \"m\", initial_rate = {across:?} }}\n\
         [kinetic]\nT = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n[forces]\n\
         along = {{ on = \"x\", value = \"-F*dot(x)/norm([dot(x), dot(y)])\" }}\n\
         across = {{ on = \"y\", value = \"-F*dot(y)/norm([dot(x), dot(y)])\" }}\n{forces}"
    );
    simulate_to_end(&text, &grid(until, 20), solver, (1e-9, f64::INFINITY))
}

const ACROSS: [f64; 9] = [0.5, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 0.0];

#[test]
fn straight_stop_takes_as_many_evaluations_for_any_velocity_across() {
    for solver in [Solver::Rk, Solver::Radau, Solver::Auto] {
        for across in ACROSS {
            let motion = simulate(across, "", solver, 1.0);
            let evaluations = motion.trajectory.statistics.evaluations;
            assert!(evaluations < 1500, "{solver}, {across:e}: {evaluations}");
            let speed = 1.0_f64.hypot(across);
            let path = 0.5 * speed * speed / DECELERATION;
            let end = &motion.trajectory.final_state;
            assert!((end[0] - path / speed).abs() < 1e-8, "{across:e}: {end:?}");
            let error = (end[1] - path * across / speed).abs();
            assert!(error < 1e-8 * across.max(1e-9), "{across:e}: {end:?}");
        }
    }
}

#[test]
fn repeated_stops_take_as_many_evaluations_for_any_velocity_across() {
    let forces = "push = { on = \"x\", value = \"P*sin(w*t)\" }\n";
    for solver in [Solver::Rk, Solver::Radau, Solver::Auto] {
        for across in ACROSS {
            let motion = simulate(across, forces, solver, 3.0);
            let evaluations = motion.trajectory.statistics.evaluations;
            assert!(evaluations < 15_000, "{solver}, {across:e}: {evaluations}");
        }
    }
}
