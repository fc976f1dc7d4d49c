//! Tests of friction against the direction of sliding, with any lateral velocity, and together with contacts and
//! constraints.

use eomgen_compiled_model::{Motion, Solver};
use eomgen_tests::motions::{grid, simulate_to_end};

/// Deceleration by friction, in m/s^2.
const DECELERATION: f64 = 2.0;

/// Simulates a body with friction in a plane that starts with 1 m/s along x and `across` m/s along y; `forces` are
/// additional.
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
fn straight_stop_needs_equal_evaluations_for_any_lateral_velocity() {
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
fn repeated_stops_need_equal_evaluations_for_any_lateral_velocity() {
    let forces = "push = { on = \"x\", value = \"P*sin(w*t)\" }\n";
    for solver in [Solver::Rk, Solver::Radau, Solver::Auto] {
        for across in ACROSS {
            let motion = simulate(across, forces, solver, 3.0);
            let evaluations = motion.trajectory.statistics.evaluations;
            assert!(evaluations < 15_000, "{solver}, {across:e}: {evaluations}");
        }
    }
}

/// Angles of a wall or a wire, in rad.
const ANGLES: [f64; 3] = [0.0, 0.7, 2.5];

/// Returns a puck that a force drives along a guide, in rotated axes. Without `guide`, the friction is scalar. With
/// `guide`, the friction acts in the plane, and this part of a specification keeps the puck on the guide.
fn on_guide(angle: f64, guide: Option<&str>) -> String {
    let (c, s) = (angle.cos(), angle.sin());
    let (coordinates, kinetic, friction) = match guide {
        None => (
            "x = { unit = \"m\" }",
            "dot(x)^2",
            "friction = { on = \"x\", value = \"-F*sign(dot(x))\" }\n\
             drive = { on = \"x\", value = \"P*sin(w*t)\" }\n",
        ),
        Some(_) => (
            "a = { unit = \"m\" }\nb = { unit = \"m\" }\n\
             [definitions]\nv = [\"dot(a)\", \"dot(b)\"]\nx = \"c*a + s*b\"\ny = \"c*b - s*a\"",
            "dot(v, v)",
            "friction = { on = [\"a\", \"b\"], value = \"-F*v/norm(v)\" }\n\
             drive = { on = \"x\", value = \"P*sin(w*t)\" }\npress = { on = \"y\", value = \"3*P\" }\n\
             [observables]\nx = \"x\"\n",
        ),
    };
    format!(
        "[model]\nname = \"puck\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
         F = {{ value = {DECELERATION}, unit = \"N\" }}\nP = {{ value = 3, unit = \"N\" }}\n\
         w = {{ value = 7, unit = \"rad/s\" }}\nc = {{ value = {c:?}, unit = \"1\" }}\n\
         s = {{ value = {s:?}, unit = \"1\" }}\n[coordinates]\n{coordinates}\n\
         [kinetic]\nT = \"1/2*m*{kinetic}\"\n[forces]\n{friction}{}",
        guide.unwrap_or_default()
    )
}

#[test]
fn puck_along_a_wall_or_a_wire_rests_and_slides_like_scalar_friction() {
    let times = grid(3.0, 30);
    for angle in ANGLES {
        let scalar = on_guide(angle, None);
        let alone = simulate_to_end(&scalar, &times, Solver::Rk, (1e-10, f64::INFINITY));
        for guide in [
            "[impacts]\nwall = { when = \"-y\", restitution = 0 }\n",
            "[constraints]\nwire = { zero = \"y\" }\n",
        ] {
            for solver in [Solver::Rk, Solver::Radau] {
                let text = on_guide(angle, Some(guide));
                let motion = simulate_to_end(&text, &times, solver, (1e-9, f64::INFINITY));
                let states = &motion.trajectory.states;
                for (own, right) in states.iter().zip(&alone.trajectory.states) {
                    let x = angle.cos() * own[0] + angle.sin() * own[1];
                    let error = (x - right[0]).abs();
                    assert!(error < 1e-7, "{solver}, {angle}, {guide}: {own:?}");
                }
            }
        }
    }
}

/// A body in a plane between two walls without restitution stops in the corner in which both contacts close.
#[test]
fn puck_in_a_corner_rests() {
    for angle in ANGLES {
        let text = on_guide(
            angle,
            Some(
                "[impacts]\nwall = { when = \"-y\", restitution = 0 }\n\
                 end = { when = \"l - x\", restitution = 0 }\n",
            ),
        );
        let text = text.replace("P*sin(w*t)", "P").replace(
            "[coordinates]",
            "l = { value = 0.02, unit = \"m\" }\n[coordinates]",
        );
        for solver in [Solver::Rk, Solver::Radau] {
            let times = grid(1.0, 10);
            let motion = simulate_to_end(&text, &times, solver, (1e-9, f64::INFINITY));
            let [a, b, a_dot, b_dot] = motion.trajectory.final_state[..] else {
                panic!("{motion:?}");
            };
            let (x, y) = (
                angle.cos() * a + angle.sin() * b,
                angle.cos() * b - angle.sin() * a,
            );
            assert!((x - 0.02).abs() < 1e-12 && y.abs() < 1e-12, "{x} {y}");
            assert!(a_dot.hypot(b_dot) < 1e-12, "{solver}: {a_dot} {b_dot}");
        }
    }
}

#[test]
fn contact_of_another_body_does_not_move_a_resting_puck() {
    let text = "[model]\nname = \"puck_and_ball\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
        g = { value = 9.81, unit = \"m/s^2\" }\nmu = { value = 0.5, unit = \"1\" }\n[coordinates]\n\
        a = { unit = \"m\", initial_rate = -0.8 }\nb = { unit = \"m\", initial_rate = -0.6 }\n\
        y = { unit = \"m\", initial = 1 }\n[definitions]\nv = [\"dot(a)\", \"dot(b)\"]\n\
        [kinetic]\nball = \"1/2*m*dot(y)^2\"\npuck = \"1/2*m*dot(v, v)\"\n[potential]\nheight = \"m*g*y\"\n\
        [forces]\nfriction = { on = [\"a\", \"b\"], value = \"-mu*m*g*v/norm(v)\" }\n\
        [impacts]\nfloor = { when = \"y\", restitution = 0 }\n";
    let path = 1.0 / (2.0 * 0.5 * 9.81);
    for restitution in ["0", "0.5"] {
        let text = text.replace("restitution = 0", &format!("restitution = {restitution}"));
        for solver in [Solver::Rk, Solver::Radau] {
            let motion = simulate_to_end(&text, &grid(1.5, 15), solver, (1e-9, f64::INFINITY));
            let end = &motion.trajectory.final_state;
            let error = (end[0] + 0.8 * path).hypot(end[1] + 0.6 * path);
            assert!(error < 1e-9 && end[2].abs() < 1e-12, "{solver}: {end:?}");
            assert_eq!(end[3..5], [0.0, 0.0], "{solver}, {restitution}");
        }
    }
}
