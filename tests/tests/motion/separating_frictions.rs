//! Tests of two frictions on one body whose directions coincide at one time only. One friction along x is sticking; the
//! direction of the other friction rotates.

use eomgen_compiled_model::{Motion, Solver};
use eomgen_tests::motions::{grid, simulate_to_end};

/// Angles of the axes x and y to the coordinates, in rad.
const ANGLES: [f64; 3] = [0.0, 0.7, -2.1];

const SOLVERS: [Solver; 2] = [Solver::Rk, Solver::Radau];

/// Initial position (m) and speed (m/s) along y.
const BEFORE: (f64, f64) = (-0.3, 0.8);

const DRY: &str = "first = { on = [\"a\", \"b\"], value = \"-F*sign(dot(v, e))*e\" }\n\
                   second = { on = [\"a\", \"b\"], value = \"-G*sign(dot(v, n))*n\" }\n";

const CONTACTS: &str = "[impacts]\nfirst = { when = \"h\", restitution = 0, friction = \"F/N\", slip = \"dot(v, e)\" }\n\
                        second = { when = \"k\", restitution = 0, friction = \"G/N\", slip = \"dot(v, n)\" }\n";

/// Simulates a body that a force (N) pushes along y. The second friction acts in a direction at the angle `turned`
/// (rad) from x.
fn simulate(
    (angle, solver): (f64, Solver),
    (place, speed): (f64, f64),
    (push, turned, frictions): (f64, &str, &str),
    until: f64,
) -> Motion {
    let (s, c) = angle.sin_cos();
    let text = format!(
        "[model]\nname = \"body\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
         l = {{ value = 1, unit = \"m\" }}\nw = {{ value = 1, unit = \"rad/s\" }}\n\
         F = {{ value = 2, unit = \"N\" }}\nG = {{ value = 1, unit = \"N\" }}\n\
         N = {{ value = 1, unit = \"N\" }}\nP = {{ value = {push:?}, unit = \"N\" }}\n\
         c = {{ value = {c:?} }}\ns = {{ value = {s:?} }}\n[coordinates]\n\
         a = {{ unit = \"m\", initial = {:?}, initial_rate = {:?} }}\n\
         b = {{ unit = \"m\", initial = {:?}, initial_rate = {:?} }}\n\
         h = {{ unit = \"m\" }}\nk = {{ unit = \"m\" }}\n[definitions]\n\
         y = \"c*b - s*a\"\nq = \"{turned}\"\nv = [\"dot(a)\", \"dot(b)\"]\ne = [\"c\", \"s\"]\n\
         n = [\"c*cos(q) - s*sin(q)\", \"s*cos(q) + c*sin(q)\"]\n\
         [kinetic]\nT = \"1/2*m*(dot(v, v) + dot(h)^2 + dot(k)^2)\"\n[potential]\nV = \"N*(h + k)\"\n\
         [observables]\nx = \"c*a + s*b\"\ny = \"y\"\nu = \"dot(y)\"\n\
         [forces]\npush = {{ on = \"y\", value = \"P\" }}\n{frictions}",
        -s * place,
        -s * speed,
        c * place,
        c * speed
    );
    simulate_to_end(&text, &grid(until, 20), solver, (1e-10, f64::INFINITY))
}

/// Returns x, y and the speed along y for a state.
fn along_axes(angle: f64, state: &[f64]) -> [f64; 3] {
    let (s, c) = angle.sin_cos();
    [
        c * state[0] + s * state[1],
        c * state[1] - s * state[0],
        c * state[5] - s * state[4],
    ]
}

/// Calls `check` for all angles, solvers and kinds of friction.
fn for_all(check: impl Fn((f64, Solver), &str)) {
    for angle in ANGLES {
        for solver in SOLVERS {
            for frictions in [DRY, CONTACTS] {
                check((angle, solver), frictions);
            }
        }
    }
}

#[test]
fn body_stops_after_it_passes_the_common_direction() {
    for_all(|run, frictions| {
        for push in [0.0, 0.2, -0.2] {
            let motion = simulate(run, BEFORE, (push, "y/l", frictions), 4.0);
            let [x, y, speed] = along_axes(run.0, &motion.trajectory.final_state);
            // The friction along y is G sin(y). At rest, the initial energy minus the work of the friction is zero.
            let (place, start) = BEFORE;
            let rest =
                |y: f64| 0.5 * start * start + push * (y - place) - 2.0 + place.cos() + y.cos();
            assert!(rest(y).abs() < 1e-8, "{run:?} {push} {frictions}: {y}");
            assert!(y > 0.4 && x.abs() < 1e-9, "{run:?} {push}: {x} {y}");
            assert!(speed.abs() < 1e-9, "{run:?} {push}: {speed}");
        }
    });
}

#[test]
fn body_starts_from_rest_in_another_direction_than_the_common_one() {
    for_all(|run, frictions| {
        let motion = simulate(run, (0.0, 0.0), (1.0, "y/l", frictions), 1.0);
        let [x, y, speed] = along_axes(run.0, &motion.trajectory.final_state);
        let squared = 2.0 * (y - (1.0 - y.cos()));
        assert!(
            (speed * speed - squared).abs() < 1e-8 && x.abs() < 1e-9,
            "{run:?} {frictions}: {x} {y} {speed}"
        );
        // y'' = 1 - sin(y).
        assert!((y - 0.460_011_276_1).abs() < 1e-8, "{run:?}: {y}");
        let evaluations = motion.trajectory.statistics.evaluations;
        assert!(evaluations < 5000, "{run:?} {frictions}: {evaluations}");
    });
}

#[test]
fn body_stops_in_a_direction_that_turns_with_time() {
    for_all(|run, frictions| {
        let motion = simulate(run, (0.0, 0.0), (0.5, "w*t", frictions), 2.0);
        let [x, y, speed] = along_axes(run.0, &motion.trajectory.final_state);
        // y'' = 1/2 - sin(t) until the speed t/2 + cos(t) - 1 is zero.
        let stop: f64 = 1.109_144_181_66;
        let expected = stop * stop / 4.0 + stop.sin() - stop;
        assert!(
            (y - expected).abs() < 1e-8 && x.abs() < 1e-9 && speed.abs() < 1e-9,
            "{run:?} {frictions}: {x} {y} {speed}, not {expected}"
        );
    });
}

#[test]
fn belt_slips_on_a_block_that_sticks_to_the_floor() {
    // While the belt is faster than the block, it pushes with 1 N and the block accelerates with 0.5 m/s^2. Then belt
    // and floor decelerate the block with 1.5 m/s^2.
    let mut reached = 1.0;
    for _ in 0..20 {
        let belt = |t: f64| 10.0 * (std::f64::consts::PI * t).sin() - 0.5 * t;
        let slope = 10.0 * std::f64::consts::PI * (std::f64::consts::PI * reached).cos() - 0.5;
        reached -= belt(reached) / slope;
    }
    let speed = 0.5 * reached;
    let expected = 0.25 * reached * reached + speed * speed / 3.0;
    for solver in SOLVERS {
        let text = "[model]\nname = \"belt\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
             F = { value = 3, unit = \"N\" }\nG = { value = 1, unit = \"N\" }\nP = { value = 2.5, unit = \"N\" }\n\
             U = { value = 10, unit = \"m/s\" }\nw = { value = 3.141592653589793, unit = \"rad/s\" }\n\
             [coordinates]\nx = { unit = \"m\" }\n[kinetic]\nT = \"1/2*m*dot(x)^2\"\n[forces]\n\
             push = { on = \"x\", value = \"P\" }\nfloor = { on = \"x\", value = \"-F*sign(dot(x))\" }\n\
             belt = { on = \"x\", value = \"-G*sign(dot(x) - U*sin(w*t))\" }\n";
        let motion = simulate_to_end(text, &grid(1.9, 20), solver, (1e-10, f64::INFINITY));
        let end = &motion.trajectory.final_state;
        assert!(
            (end[0] - expected).abs() < 1e-8 && end[1].abs() < 1e-9,
            "{solver}: {end:?}, not {expected}"
        );
    }
}

#[test]
fn block_released_by_a_contact_sticks_to_the_floor_at_the_friction_bound() {
    // The force of the belt cancels the load. The contact acts with cos(t) < 1 along x, and with sin(t) along y.
    let text = "[model]\nname = \"block\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
         K = { value = 1, unit = \"N\" }\nw = { value = 1, unit = \"1/s\" }\nU = { value = 1, unit = \"m/s\" }\n\
         [coordinates]\nx = { unit = \"m\" }\ny = { unit = \"m\" }\nh = { unit = \"m\" }\n\
         [kinetic]\nT = \"1/2*m*(dot(x)^2 + dot(y)^2 + dot(h)^2)\"\n[potential]\nV = \"K*h\"\n[forces]\n\
         push = { on = \"y\", value = \"K\" }\nload = { on = \"x\", value = \"3*K\" }\n\
         floor = { on = \"x\", value = \"-K*sign(dot(x))\" }\n\
         belt = { on = \"x\", value = \"-3*K*sign(dot(x) + U*w*t)\" }\n[impacts]\n\
         c = { when = \"h\", restitution = 0, friction = 1, slip = \"cos(w*t)*dot(x) + sin(w*t)*dot(y)\" }\n";
    for solver in SOLVERS {
        let motion = simulate_to_end(text, &grid(1.0, 2), solver, (1e-10, f64::INFINITY));
        let end = &motion.trajectory.final_state;
        // y'' = 1 - sin(t).
        let expected = 1.0_f64.sin() - 0.5;
        assert!(
            end[0].abs() < 1e-9 && (end[1] - expected).abs() < 1e-8,
            "{solver}: {end:?}, not {expected}"
        );
    }
}
