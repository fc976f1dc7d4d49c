//! Tests of friction at rest. Machines with constraints are compared with the same machines in independent coordinates.
//! Machines with closed contacts are compared with the same machines with constraints.

use std::fmt::Write as _;

use eomgen_compiled_model::Solver;

use super::rows::Numbers;
use super::{GENERAL, compile_text, grid, simulated};

/// Bead on a straight wire with dry friction.
const BEAD_ON_WIRE: &str = r#"
[model]
name = "bead"
[parameters]
m = { value = 1, unit = "kg" }
F = { value = 2, unit = "N" }
A = { value = 4.5, unit = "N" }
w = { value = 3, unit = "rad/s" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
[definitions]
s = "(2*x + y)/sqrt(5)"
[kinetic]
bead = "1/2*m*(dot(x)^2 + dot(y)^2)"
[constraints]
wire = { zero = "x - 2*y" }
[forces]
drive = { on = "x", value = "A*sin(w*t)" }
friction = { on = "s", value = "-F*sign(dot(s))" }
"#;

const BLOCK: &str = r#"
[model]
name = "block"
[parameters]
m = { value = 1, unit = "kg" }
F = { value = 2, unit = "N" }
A = { value = 4.5, unit = "N" }
w = { value = 3, unit = "rad/s" }
[coordinates]
s = { unit = "m" }
[kinetic]
block = "1/2*m*dot(s)^2"
[forces]
drive = { on = "s", value = "2/sqrt(5)*A*sin(w*t)" }
friction = { on = "s", value = "-F*sign(dot(s))" }
"#;

/// Bead on a ring in Cartesian coordinates; a force opposite to its velocity is undefined at rest.
const BEAD_ON_RING: &str = r#"
[model]
name = "bead_on_ring"
[parameters]
m = { value = 1, unit = "kg" }
F = { value = 1, unit = "N" }
R = { value = 1, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
x = { unit = "m", initial = "R" }
y = { unit = "m" }
[definitions]
position = "[x, y]"
velocity = "dot(position)"
[kinetic]
bead = "1/2*m*dot(velocity, velocity)"
[potential]
weight = "m*g*y"
[constraints]
ring = { zero = "norm(position) - R" }
[forces]
friction = { on = "position", value = "-F*velocity/norm(velocity)" }
"#;

/// The bead on a ring with its angle as coordinate.
const RING_ANGLE: &str = r#"
[model]
name = "ring_angle"
[parameters]
m = { value = 1, unit = "kg" }
F = { value = 1, unit = "N" }
R = { value = 1, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
phi = { unit = "rad" }
[kinetic]
bead = "1/2*m*R^2*dot(phi)^2"
[potential]
weight = "m*g*R*sin(phi)"
[forces]
friction = { on = "phi", value = "-F*R*sign(dot(phi))" }
"#;

/// Pendulum with dry friction in its joint, in Cartesian coordinates.
const PENDULUM_ON_ROD: &str = r#"
[model]
name = "pendulum_on_rod"
[parameters]
m = { value = 1, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
M = { value = 2.5, unit = "N m" }
l = { value = 0.7, unit = "m" }
[coordinates]
x = { unit = "m", initial = "l*sin(1.4)" }
y = { unit = "m", initial = "-l*cos(1.4)" }
[definitions]
omega = "(x*dot(y) - y*dot(x))/l^2"
[kinetic]
bob = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[constraints]
rod = { zero = "x^2 + y^2 - l^2" }
[forces]
joint_x = { on = "x", value = "M*sign(omega)*y/l^2" }
joint_y = { on = "y", value = "-M*sign(omega)*x/l^2" }
"#;

const PENDULUM: &str = r#"
[model]
name = "pendulum"
[parameters]
m = { value = 1, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
M = { value = 2.5, unit = "N m" }
l = { value = 0.7, unit = "m" }
[coordinates]
theta = { unit = "rad", initial = 1.4 }
[kinetic]
bob = "1/2*m*l^2*dot(theta)^2"
[potential]
weight = "-m*g*l*cos(theta)"
[forces]
joint = { on = "theta", value = "-M*sign(dot(theta))" }
"#;

#[test]
fn bead_on_wire_sticks_and_slides_as_block_at_any_size() {
    let times = grid(4.0, 40);
    for size in [1.0, 1e-9, 1e6] {
        let scaled = |text: &str| {
            let text = text.replace("value = 2,", &format!("value = {:e},", 2.0 * size));
            compile_text(&text.replace("value = 4.5,", &format!("value = {:e},", 4.5 * size)))
        };
        let (bead, block) = (scaled(BEAD_ON_WIRE), scaled(BLOCK));
        for solver in GENERAL {
            let found = simulated(&bead, &[], &times, solver).trajectory;
            let expected = simulated(&block, &[], &times, solver).trajectory;
            assert_eq!(found.events.len(), 4, "{solver} {size}");
            for (event, other) in found.events.iter().zip(&expected.events) {
                assert!(
                    (event.t - other.t).abs() < 1e-8,
                    "{solver} {size}: {event:?}"
                );
                assert_eq!((event.from, event.to), (other.from, other.to));
            }
            for (state, other) in found.states.iter().zip(&expected.states) {
                let s = (2.0 * state[0] + state[1]) / 5.0_f64.sqrt();
                assert!(
                    (s - other[0]).abs() < 1e-8 * size,
                    "{solver} {size}: {state:?}"
                );
                let residual = state[0] - 2.0 * state[1];
                assert!(residual.abs() < 1e-12 * size, "{solver} {size}: {state:?}");
            }
        }
    }
}

#[test]
fn bead_on_ring_starts_from_rest_and_stops_as_in_its_angle() {
    let times = grid(4.0, 40);
    let (ring, angle) = (compile_text(BEAD_ON_RING), compile_text(RING_ANGLE));
    for force in [0.5, 1.0, 5.0] {
        let settings = [("F", force)];
        let found = simulated(&ring, &settings, &times, Solver::Rk).trajectory;
        let expected = simulated(&angle, &settings, &times, Solver::Rk).trajectory;
        for (state, other) in found.states.iter().zip(&expected.states) {
            let place = [other[0].cos(), other[0].sin()];
            for (found, expected) in state.iter().zip(place) {
                assert!(
                    (found - expected).abs() < 1e-7,
                    "{force}: {state:?}, expected {place:?}"
                );
            }
        }
    }
}

#[test]
fn pendulum_on_rod_comes_to_rest_as_in_its_angle() {
    let times = grid(4.0, 40);
    for solver in GENERAL {
        let angle = simulated(&compile_text(PENDULUM), &[], &times, solver);
        let cartesian = simulated(&compile_text(PENDULUM_ON_ROD), &[], &times, solver);
        let pairs = cartesian
            .trajectory
            .states
            .iter()
            .zip(&angle.trajectory.states);
        for (state, other) in pairs {
            let expected = [0.7 * other[0].sin(), -0.7 * other[0].cos()];
            for (found, expected) in state.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-7, "{solver}: {state:?}");
            }
        }
        let last = &cartesian.trajectory.states[40];
        assert!(last[2..].iter().all(|rate| rate.abs() < 1e-13), "{last:?}");
    }
}

/// Returns a machine of three coordinates with coupled inertias, dry friction at each coordinate, periodic drives, and
/// a load that presses on a surface. `section` requires that the machine is on the surface where `distance` is zero.
fn pressed_machine(seed: u64, section: &str) -> String {
    let mut numbers = Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let mut next = |low: f64, high: f64| low + (high - low) * numbers.next();
    let names = ["a", "b", "c"];
    let mut text =
        "[model]\nname = \"pressed\"\n[parameters]\nN = { value = 200, unit = \"N\" }\n".to_owned();
    text += "omega = { value = 1, unit = \"rad/s\" }\nkg = { value = 1, unit = \"kg\" }\n";
    text += "force = { value = 1, unit = \"N\" }\n[coordinates]\n";
    for name in names {
        writeln!(text, "{name} = {{ unit = \"m\" }}").expect("text");
    }
    let slopes = [next(-1.0, 1.0), next(-1.0, 1.0)];
    let distance = format!("c + {:.3}*a + {:.3}*b", slopes[0], slopes[1]);
    writeln!(text, "[definitions]\ndistance = \"{distance}\"\n[kinetic]").expect("text");
    for (place, name) in names.into_iter().enumerate() {
        let other = names[(place + 1) % 3];
        let (own, coupled) = (next(1.0, 3.0), next(-1.0, 1.0));
        writeln!(
            text,
            "{name} = \"1/2*kg*({own:.3}*dot({name})^2 + (dot({name}) + {coupled:.3}*dot({other}))^2)\""
        )
        .expect("text");
    }
    writeln!(text, "[potential]\nload = \"N*distance\"\n[forces]").expect("text");
    for name in names {
        let (level, push) = (next(1.0, 4.0), next(2.0, 8.0));
        let (rate, phase) = (next(2.0, 5.0), next(0.0, 6.0));
        writeln!(
            text,
            "rub_{name} = {{ on = \"{name}\", value = \"-{level:.3}*force*sign(dot({name}))\" }}\n\
             push_{name} = {{ on = \"{name}\", value = \"{push:.3}*force*sin({rate:.3}*omega*t + {phase:.3})\" }}"
        )
        .expect("text");
    }
    text + section
}

#[test]
fn friction_with_closed_contact_matches_constraint() {
    let times = grid(3.0, 30);
    let contact = "[impacts]\nfloor = { when = \"distance\", restitution = 0.5 }\n";
    let constraint = "[constraints]\nfloor = { zero = \"distance\" }\n";
    let mut held = 0;
    for seed in 1..=12 {
        let pressed = compile_text(&pressed_machine(seed, contact));
        let guided = compile_text(&pressed_machine(seed, constraint));
        for solver in GENERAL {
            let found = simulated(&pressed, &[], &times, solver).trajectory;
            let expected = simulated(&guided, &[], &times, solver).trajectory;
            for (t, (state, expected)) in
                times.iter().zip(found.states.iter().zip(&expected.states))
            {
                for (entry, other) in state.iter().zip(expected) {
                    assert!(
                        (entry - other).abs() < 1e-7,
                        "{seed} {solver} {t}: {state:?} and {expected:?}"
                    );
                }
            }
            held += found.events.len();
        }
    }
    assert!(held > 100, "{held} events");
}

#[test]
fn sled_stops_at_wall_and_leaves_it_against_friction() {
    let sled = r#"
[model]
name = "sled"
[parameters]
m = { value = 2, unit = "kg" }
F = { value = 3, unit = "N" }
d = { value = 1, unit = "m" }
A = { value = 12, unit = "N" }
w = { value = 5, unit = "rad/s" }
[coordinates]
x = { unit = "m", initial_rate = 3 }
[kinetic]
T = "1/2*m*dot(x)^2"
[forces]
drive = { on = "x", value = "A*sin(w*t)" }
rub = { on = "x", value = "-F*sign(dot(x))" }
[impacts]
wall = { when = "d - x", restitution = 0 }
[observables]
friction = "-F*sign(dot(x))"
"#;
    let model = compile_text(sled);
    // The wall holds the mass while the drive pushes, and friction holds it until the drive pulls with F.
    let pi = std::f64::consts::PI;
    let (parts, leaves) = (pi / 5.0, (pi + 0.25_f64.asin()) / 5.0);
    for solver in GENERAL {
        let motion = simulated(&model, &[], &[0.0, 0.4, parts, leaves, 0.7], solver);
        let events = &motion.trajectory.events;
        let times: Vec<f64> = events.iter().map(|event| event.t).collect();
        assert_eq!(events.len(), 4, "{solver}: {events:?}");
        assert!((times[2] - parts).abs() < 1e-9, "{solver}: {events:?}");
        assert!((times[3] - leaves).abs() < 1e-9, "{solver}: {events:?}");
        for state in &motion.trajectory.states[1..4] {
            assert!(
                (state[0] - 1.0).abs() < 1e-12 && state[1].abs() < 1e-12,
                "{state:?}"
            );
        }
        // At the wall friction exerts no force; after that it balances the drive.
        let run = model.with_declared_parameters().unwrap();
        let observables = run.observables(&motion).unwrap();
        let forces = observables.iter().map(|row| row[0]);
        let expected = [-3.0, 0.0, 0.0, 3.0, 3.0];
        for (t, (force, expected)) in forces.zip(expected).enumerate() {
            assert!((force - expected).abs() < 1e-6, "{solver} {t}: {force}");
        }
        let after = 0.7 - leaves;
        // The net force F + A sin(w t) is about A w cos(w t) (t - leaves).
        let speed = 60.0 * (5.0 * leaves).cos() / 2.0 * after * after / 2.0;
        let last = motion.trajectory.states[4][1];
        assert!(
            (last / speed - 1.0).abs() < 0.02,
            "{solver}: {last} and {speed}"
        );
    }
}

#[test]
fn hammer_drives_pile_against_friction_alike_by_all_solvers() {
    let hammer = r#"
[model]
name = "hammer"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 50, unit = "N/m" }
F = { value = 2, unit = "N" }
D = { value = 1, unit = "m" }
e = { value = 0.4, unit = "1" }
A = { value = 30, unit = "N" }
w = { value = 9, unit = "rad/s" }
[coordinates]
a = { unit = "m", doc = "hammer" }
b = { unit = "m", initial = 0.05, doc = "pile" }
[kinetic]
T = "1/2*m*dot(a)^2 + m*dot(b)^2"
[potential]
V = "1/2*k*a^2"
[forces]
drive = { on = "a", value = "A*sin(w*t)" }
guide = { on = "a", value = "-F*sign(dot(a))" }
ground = { on = "b", value = "-3*F*sign(dot(b))" }
[impacts]
hit = { when = "b - a", restitution = "e" }
rock = { when = "D - b", restitution = 0 }
"#;
    let model = compile_text(hammer);
    let times = grid(20.0, 200);
    let motions = GENERAL.map(|solver| simulated(&model, &[], &times, solver).trajectory);
    let [first, second] = &motions;
    for (t, (state, other)) in times.iter().zip(first.states.iter().zip(&second.states)) {
        for (entry, other) in state.iter().zip(other) {
            assert!((entry - other).abs() < 1e-6, "{t}: {state:?} and {other:?}");
        }
    }
    // The pile rests between impacts, and at the end on the rock.
    assert!((first.states[200][1] - 1.0).abs() < 1e-12);
    assert!(first.events.len() > 100, "{}", first.events.len());
}
