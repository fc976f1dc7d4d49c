//! Tests of bodies that stick by dry friction while they touch a wall, or that a moving wall hits.

use eomgen_compiled_model::{CompiledModel, EventKind, Orders, Request, Solver};
use eomgen_tests::random_numbers::Numbers;

/// Units of length (m) and mass (kg) of the tested coordinates.
const UNITS: [(f64, f64); 2] = [(1.0, 1.0), (1e-3, 1e3)];

const SOLVERS: [Solver; 3] = [Solver::Rk, Solver::Radau, Solver::Auto];

const MACHINES: usize = 30;

fn draw_between(numbers: &mut Numbers, low: f64, high: f64) -> f64 {
    low + 0.5 * (high - low) * (1.0 + numbers.symmetric())
}

/// Returns times (s) and states of a motion without warnings.
fn simulate(text: &str, until: f64, solver: Solver) -> (Vec<f64>, Vec<Vec<f64>>) {
    let model = CompiledModel::from_text("held.toml", text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}\n{text}"));
    let run = model.with_declared_parameters().unwrap();
    let times: Vec<f64> = (0..=60)
        .map(|step| until * f64::from(step) / 60.0)
        .collect();
    let request = Request {
        initial: run.initial_state(),
        times: &times,
        inputs: &run.default_inputs(),
        solver,
        tolerance: 1e-9,
        max_step: f64::INFINITY,
        audit: true,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {});
    let motion = motion.unwrap_or_else(|error| panic!("{solver}: {error}\n{text}"));
    let stop = &motion.early_stop;
    assert!(stop.is_none(), "{solver}, {until} s: {stop:?}\n{text}");
    (times, motion.trajectory.states)
}

/// A spring alternately pulls a body away from a wall and presses it against the wall, with less force than the
/// friction. The mass at the other end of the spring oscillates freely.
#[test]
fn sticking_body_stays_at_a_wall() {
    for case in 0..MACHINES {
        let numbers = &mut Numbers(case as u64 + 1);
        let (length, mass) = UNITS[case % 2];
        let m = draw_between(numbers, 0.2, 3.0);
        let k = draw_between(numbers, 2.0, 60.0);
        let wall = draw_between(numbers, -0.2, 0.2);
        let stretch = draw_between(numbers, -0.2, 0.2);
        let speed = draw_between(numbers, -0.5, 0.5);
        let frequency = (k / (3.0 * m)).sqrt();
        let amplitude = stretch.hypot(speed / frequency);
        let friction = k * amplitude * draw_between(numbers, 1.02, 2.0);
        let distance = if stretch > 0.0 { "x - c" } else { "c - x" };
        let restitution = [0.0, 0.3, 1.0][case / 2 % 3];
        let text = format!(
            "[model]\nname = \"held\"\n[parameters]\n\
             m = {{ value = {:?}, unit = \"kg\" }}\nF = {{ value = {:?}, unit = \"N\" }}\n\
             k = {{ value = {:?}, unit = \"N/m\" }}\nc = {{ value = {:?}, unit = \"m\" }}\n\
             [coordinates]\nx = {{ unit = \"m\", initial = {:?} }}\n\
             z = {{ unit = \"m\", initial = {:?}, initial_rate = {:?} }}\n\
             [kinetic]\nx = \"1/2*m*dot(x)^2\"\nz = \"1/2*3*m*dot(z)^2\"\n\
             [potential]\nspring = \"1/2*k*(z - x)^2\"\n\
             [forces]\nfriction = {{ on = \"x\", value = \"-F*sign(dot(x))\" }}\n\
             [impacts]\nwall = {{ when = \"{distance}\", restitution = {restitution} }}\n",
            m * mass,
            friction * mass * length,
            k * mass,
            wall * length,
            wall * length,
            (wall + stretch) * length,
            speed * length
        );
        for solver in SOLVERS {
            let (times, states) = simulate(&text, 3.0, solver);
            for (t, state) in times.iter().zip(&states) {
                let phase = frequency * t;
                let free = stretch * phase.cos() + speed / frequency * phase.sin();
                let [x, z] = [0, 1].map(|place| state[place] / length - wall);
                let name = format!("{case}, {solver}, {t} s");
                assert!(x.abs() < 1e-12, "{name}: the held body moves by {x:e}");
                assert!((z - free).abs() < 1e-6 * amplitude, "{name}: {z} {free}");
            }
        }
    }
}

/// A force alternately presses a body against a wall and pulls it away, with less force than the friction. Rounding
/// errors of the position at rest must cause neither impacts nor overlaps, also if another coordinate is zero.
#[test]
fn sticking_body_at_a_wall_has_one_event() {
    for case in 0..12 {
        let numbers = &mut Numbers(case as u64 + 100);
        let m = draw_between(numbers, 0.3, 3.0);
        let push = draw_between(numbers, 0.5, 5.0);
        let friction = push * draw_between(numbers, 1.1, 2.5);
        let frequency = draw_between(numbers, 2.0, 12.0);
        let wall = [0.0, 1e-7, 0.2][case % 3];
        let restitution = [0.0, 0.3, 1.0][case / 3 % 3];
        for (length, mass) in [(1.0, 1.0), (1e-4, 1.0), (1e-6, 1e-3), (1e6, 1.0)] {
            let text = format!(
                "[model]\nname = \"held\"\n[parameters]\n\
                 m = {{ value = {:?}, unit = \"kg\" }}\nF = {{ value = {:?}, unit = \"N\" }}\n\
                 P = {{ value = {:?}, unit = \"N\" }}\nw = {{ value = {frequency:?}, unit = \"rad/s\" }}\n\
                 c = {{ value = {:?}, unit = \"m\" }}\n[coordinates]\nx = {{ unit = \"m\", initial = {:?} }}\n\
                 [kinetic]\nx = \"1/2*m*dot(x)^2\"\n[forces]\n\
                 push = {{ on = \"x\", value = \"-P*cos(w*t)\" }}\n\
                 friction = {{ on = \"x\", value = \"-F*sign(dot(x))\" }}\n\
                 [impacts]\nwall = {{ when = \"x - c\", restitution = {restitution} }}\n",
                m * mass,
                friction * mass * length,
                push * mass * length,
                wall * length,
                wall * length
            );
            for solver in SOLVERS {
                let model = CompiledModel::from_text("held.toml", &text, Orders::Declared);
                let model = model.unwrap();
                let run = model.with_declared_parameters().unwrap();
                let times: Vec<f64> = (0..=40).map(|step| 0.1 * f64::from(step)).collect();
                let request = Request {
                    initial: run.initial_state(),
                    times: &times,
                    inputs: &run.default_inputs(),
                    solver,
                    tolerance: 1e-9,
                    max_step: f64::INFINITY,
                    audit: false,
                };
                let motion = run.simulate_until_stop(&request, &mut |_| {}).unwrap();
                let name = format!("{case}, {length:e} m, {solver}");
                assert_eq!(motion.early_stop, None, "{name}");
                let overlap = run.find_first_overlap(&motion, 1e-9).unwrap();
                assert_eq!(overlap, None, "{name}");
                let kinds = motion.event_log(1).into_iter().map(|event| event.kind);
                let kinds: Vec<EventKind> = kinds.collect();
                assert_eq!(kinds, [EventKind::Separation], "{name}");
            }
        }
    }
}

/// A periodic force moves a body away from a wall and back to it, and the body stops at the wall. Samples within the
/// last step are beyond the wall by the error of dense output.
#[test]
fn sliding_body_returns_to_a_wall() {
    let (m, push, friction, frequency) = (
        0.9993229276317789,
        3.434043772798134,
        2.173572673440952,
        6.844462270317201,
    );
    for (length, mass) in [(1.0, 1.0), (1e-4, 1.0), (1e-6, 1e-3), (1e6, 1.0)] {
        for restitution in [0.0, 0.3, 1.0] {
            let text = format!(
                "[model]\nname = \"held\"\n[parameters]\n\
                 m = {{ value = {:?}, unit = \"kg\" }}\nF = {{ value = {:?}, unit = \"N\" }}\n\
                 P = {{ value = {:?}, unit = \"N\" }}\nw = {{ value = {frequency:?}, unit = \"rad/s\" }}\n\
                 [coordinates]\nx = {{ unit = \"m\" }}\n[kinetic]\nx = \"1/2*m*dot(x)^2\"\n[forces]\n\
                 push = {{ on = \"x\", value = \"-P*cos(w*t)\" }}\n\
                 friction = {{ on = \"x\", value = \"-F*sign(dot(x))\" }}\n\
                 [impacts]\nwall = {{ when = \"x\", restitution = {restitution} }}\n",
                m * mass,
                friction * mass * length,
                push * mass * length
            );
            for until in [1.3, 1.9, 2.6] {
                let (_, expected) = simulate(&text, until, Solver::Radau);
                for solver in [Solver::Rk, Solver::Auto] {
                    let (times, found) = simulate(&text, until, solver);
                    for ((t, found), expected) in times.iter().zip(&found).zip(&expected) {
                        let difference = (found[0] - expected[0]).abs() / length;
                        assert!(difference < 1e-6, "{solver}, {length:e} m, {t} s");
                    }
                }
            }
        }
    }
}

/// A body sticks on two surfaces. An oscillating wall hits it, and hits it again before it stops. Different durations
/// of the simulation vary the step sizes.
#[test]
fn sticking_body_is_hit_by_a_moving_wall() {
    for (length, mass) in UNITS {
        for step in 0..12 {
            let until = 0.5 + 0.3 * f64::from(step);
            let parameter = |name: &str, value: f64, unit: &str| {
                format!("{name} = {{ value = {value:?}, unit = \"{unit}\" }}\n")
            };
            let parameters = [
                parameter("c", -0.132 * length, "m"),
                parameter("a", 0.0157 * length, "m"),
                parameter("w", 14.4, "1/s"),
                parameter("g", 0.126 * length, "m"),
                parameter("m", 1.01 * mass, "kg"),
                parameter("k", 19.9 * mass, "N/m"),
                parameter("P", 2.18 * mass * length, "N"),
                parameter("F", 21.963 * mass * length, "N"),
                parameter("G", 3.99 * mass * length, "N"),
            ];
            let text = format!(
                "[model]\nname = \"hit\"\n[parameters]\n{}[coordinates]\n\
                 x = {{ unit = \"m\", initial = {:?}, initial_rate = {:?} }}\n\
                 y = {{ unit = \"m\", initial = {:?}, initial_rate = 0 }}\n\
                 [kinetic]\nx = \"1/2*m*dot(x)^2\"\ny = \"m*dot(y)^2\"\n\
                 [potential]\nspring = \"1/2*k*x^2\"\n\
                 [forces]\npush = {{ on = \"y\", value = \"P\" }}\n\
                 ground = {{ on = \"x\", value = \"-F*sign(dot(x))\" }}\n\
                 between = {{ on = \"y - x\", value = \"-G*sign(dot(y) - dot(x))\" }}\n\
                 [impacts]\nwall = {{ when = \"-x + c - a*sin(w*t)\", restitution = 0.44 }}\n\
                 stop = {{ when = \"-y + g\", restitution = 0.65 }}\n",
                parameters.concat(),
                -0.182 * length,
                1.414 * length,
                -0.146 * length
            );
            let (_, expected) = simulate(&text, until, Solver::Radau);
            for solver in [Solver::Rk, Solver::Auto] {
                let (times, found) = simulate(&text, until, solver);
                for ((t, found), expected) in times.iter().zip(&found).zip(&expected) {
                    for place in 0..2 {
                        let difference = (found[place] - expected[place]).abs() / length;
                        assert!(
                            difference < 1e-6,
                            "{solver}, {until} s, {t} s: {difference:e}"
                        );
                    }
                }
            }
        }
    }
}

/// A body hits a wall without restitution and sticks there by dry friction. Then another body of any mass hits it. The
/// wall takes the impulse in the same impact, and the other body rebounds with its speed.
#[test]
fn body_sticking_at_a_wall_stays_in_contact_after_a_collision() {
    for case in 0..MACHINES {
        let numbers = &mut Numbers(case as u64 + 1);
        let (length, mass) = UNITS[case % 2];
        let [m, other] = [(); 2].map(|()| draw_between(numbers, 0.3, 3.0));
        let friction = m * draw_between(numbers, 0.3, 0.8);
        let (speed, other_speed) = (
            draw_between(numbers, 1.0, 3.0),
            draw_between(numbers, 0.3, 0.8),
        );
        let text = format!(
            "[model]\nname = \"held\"\n[parameters]\n\
             m = {{ value = {:?}, unit = \"kg\" }}\nM = {{ value = {:?}, unit = \"kg\" }}\n\
             F = {{ value = {:?}, unit = \"N\" }}\n\
             [coordinates]\n\
             a = {{ unit = \"m\", initial = {:?}, initial_rate = {:?} }}\n\
             b = {{ unit = \"m\", initial = {:?}, initial_rate = {:?} }}\n\
             [kinetic]\na = \"1/2*m*dot(a)^2\"\nb = \"1/2*M*dot(b)^2\"\n\
             [forces]\nfriction = {{ on = \"a\", value = \"-F*sign(dot(a))\" }}\n\
             [impacts]\nwall = {{ when = \"a\", restitution = 0 }}\nhit = {{ when = \"b - a\", restitution = 1 }}\n",
            m * mass,
            other * mass,
            friction * mass * length,
            0.14 * length,
            -speed * length,
            1.1 * length,
            -other_speed * length,
        );
        for solver in SOLVERS {
            let (_, states) = simulate(&text, 5.0, solver);
            let end = states.last().expect("a state");
            assert!(
                (end[3] - other_speed * length).abs() < 1e-9 * length
                    && end[2].abs() < 1e-12 * length,
                "{solver}: {end:?}\n{text}"
            );
        }
    }
}

/// The upper of two stacked bodies is alternately pulled up and pressed down, with less force than its weight plus the
/// friction between them. The contact between them opens while they stick together. When the friction slips, the
/// contact must carry a load again.
#[test]
fn stack_with_friction_between_bodies_stays_at_rest() {
    for case in 0..MACHINES {
        let numbers = &mut Numbers(case as u64 + 101);
        let (length, mass) = UNITS[case % 2];
        let level = draw_between(numbers, 0.3, 1.3);
        let pull = draw_between(numbers, 1.0, 0.98 + level);
        let text = format!(
            "[model]\nname = \"stack\"\n[parameters]\n\
             m = {{ value = {:?}, unit = \"kg\" }}\ng = {{ value = {:?}, unit = \"m/s^2\" }}\n\
             level = {{ value = {level:?}, unit = \"1\" }}\npull = {{ value = {pull:?}, unit = \"1\" }}\n\
             w = {{ value = {:?}, unit = \"rad/s\" }}\nphase = {{ value = {:?}, unit = \"rad\" }}\n\
             [coordinates]\ny1 = {{ unit = \"m\" }}\ny2 = {{ unit = \"m\" }}\n\
             [kinetic]\nT = \"1/2*m*(dot(y1)^2 + dot(y2)^2)\"\n[potential]\nV = \"m*g*(y1 + y2)\"\n\
             [forces]\nfriction = {{ on = \"y2 - y1\", value = \"-level*m*g*sign(dot(y2) - dot(y1))\" }}\n\
             load = {{ on = \"y2\", value = \"pull*m*g*sin(w*t + phase)\" }}\n\
             [impacts]\nfloor = {{ when = \"y1\", restitution = 0 }}\n\
             joint = {{ when = \"y2 - y1\", restitution = 0 }}\n",
            mass * draw_between(numbers, 0.2, 3.0),
            9.81 * length,
            draw_between(numbers, 3.0, 12.0),
            draw_between(numbers, 0.0, 6.0),
        );
        for solver in SOLVERS {
            let (times, states) = simulate(&text, 3.0, solver);
            for (t, state) in times.iter().zip(&states) {
                let largest = state
                    .iter()
                    .fold(0.0_f64, |most, entry| most.max(entry.abs()));
                assert!(
                    largest < 1e-9 * length,
                    "{solver}, t = {t}: {state:?}\n{text}"
                );
            }
        }
    }
}
