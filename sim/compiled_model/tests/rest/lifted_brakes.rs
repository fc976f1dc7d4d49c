//! Friction that holds, vanishes and acts again: the motion begins when it vanishes, and is braked
//! afterwards instead of stopped at once.

use eomgen_sim::inputs::HeldInputs;

use crate::{GENERAL, grid, of_text};

/// Returns a mass of 1 kg that a force of 1 N drives, with this friction, and a body at a speed of
/// 1 m/s.
fn braked_mass(friction: &str) -> String {
    format!(
        r#"
[model]
name = "braked_mass"
[parameters]
m = {{ value = 1, unit = "kg" }}
F = {{ value = 3, unit = "N" }}
D = {{ value = 1, unit = "N" }}
s = {{ value = 1, unit = "s" }}
one = {{ value = 1, unit = "m" }}
[coordinates]
x = {{ unit = "m" }}
z = {{ unit = "m" }}
y = {{ unit = "m", initial_rate = 1 }}
[inputs]
u = {{ unit = "1" }}
[definitions]
v = "[dot(x), dot(z)]"
[kinetic]
T = "1/2*m*(dot(x)^2 + dot(z)^2 + dot(y)^2)"
[forces]
{friction}
drive = {{ on = "x", value = "D" }}
"#
    )
}

#[test]
fn brake_that_is_lifted_and_applied_again_stops_the_mass_in_time() {
    // Lifted from 1 s to 3 s: 2 m/s at x = 2 m, then a deceleration of 2 m/s^2 for 1 s.
    let by_input = "brake = { on = \"x\", value = \"-F*u*sign(dot(x))\" }";
    let by_body = "brake = { on = \"x\", value = \"-F*(1 - above(y - one) + above(y - 3*one))*sign(dot(x))\" }";
    let by_time =
        "brake = { on = \"x\", value = \"-F*(1 - above(t/s - 1) + above(t/s - 3))*sign(dot(x))\" }";
    let of_vector = "brake = { on = \"[x, z]\", value = \"-F*u*v/norm(v)\" }";
    let inputs = HeldInputs::new(vec![0.0, 1.0, 3.0], vec![1.0, 0.0, 1.0], 1).expect("inputs");
    for friction in [by_input, by_body, by_time, of_vector] {
        let model = of_text(&braked_mass(friction));
        let run = model.with_declared_parameters().expect("values");
        for solver in GENERAL {
            let motion = run
                .simulate(run.initial_state(), &grid(6.0, 12), &inputs, solver)
                .unwrap_or_else(|error| panic!("{friction} {solver}: {error}"));
            let states = &motion.trajectory.states;
            for (sample, [x, rate]) in [
                (2, [0.0, 0.0]),
                (4, [0.5, 1.0]),
                (6, [2.0, 2.0]),
                (7, [2.75, 1.0]),
                (8, [3.0, 0.0]),
                (12, [3.0, 0.0]),
            ] {
                let state = &states[sample];
                let place = format!("{friction} {solver} {sample}: {state:?}");
                assert!((state[0] - x).abs() < 1e-7, "{place}");
                assert!((state[3] - rate).abs() < 1e-7, "{place}");
            }
        }
    }
}
