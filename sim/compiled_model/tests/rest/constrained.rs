//! Friction at rest beside constraints, compared with the same machine in independent coordinates.

use super::{GENERAL, grid, of_text, simulated};

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
            of_text(&text.replace("value = 4.5,", &format!("value = {:e},", 4.5 * size)))
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
fn pendulum_on_rod_comes_to_rest_as_in_its_angle() {
    let times = grid(4.0, 40);
    for solver in GENERAL {
        let angle = simulated(&of_text(PENDULUM), &[], &times, solver);
        let cartesian = simulated(&of_text(PENDULUM_ON_ROD), &[], &times, solver);
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
