//! Tests of friction that holds a mass, vanishes and acts again. The motion begins when the friction vanishes. Friction
//! that returns brakes the mass but does not stop it at once.

use eomgen_compiled_model::EventKind;
use eomgen_sim::inputs::HeldInputs;

use crate::{GENERAL, compile_text, grid};

/// Returns a mass of 1 kg with friction and a driving force of 1 N, and a body with a speed of 1 m/s.
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
    // The brake is lifted from 1 s to 3 s. The mass reaches 2 m/s at x = 2 m; then it decelerates with 2 m/s^2 for 1 s.
    let by_input = "brake = { on = \"x\", value = \"-F*u*sign(dot(x))\" }";
    let by_body = "brake = { on = \"x\", value = \"-F*(1 - above(y - one) + above(y - 3*one))*sign(dot(x))\" }";
    let by_time =
        "brake = { on = \"x\", value = \"-F*(1 - above(t/s - 1) + above(t/s - 3))*sign(dot(x))\" }";
    let of_vector = "brake = { on = \"[x, z]\", value = \"-F*u*v/norm(v)\" }";
    let inputs = HeldInputs::new(vec![0.0, 1.0, 3.0], vec![1.0, 0.0, 1.0], 1).expect("inputs");
    for friction in [by_input, by_body, by_time, of_vector] {
        let model = compile_text(&braked_mass(friction));
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

/// A mass on a spring stops at its first reversal while the brake is lifted. At the next reversal the brake acts and
/// holds it.
#[test]
fn brake_that_is_lifted_at_a_reversal_holds_at_the_next_one() {
    let model = compile_text(
        r#"
[model]
name = "braked_spring"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 1, unit = "N/m" }
F = { value = 0.8, unit = "N" }
s = { value = 1, unit = "s" }
[coordinates]
x = { unit = "m", initial = 1 }
[kinetic]
T = "1/2*m*dot(x)^2"
[potential]
V = "1/2*k*x^2"
[forces]
brake = { on = "x", value = "-F*above(t/s - 4)*sign(dot(x))" }
"#,
    );
    // The mass follows cos(t) until 4 s, then oscillates about -0.8 m until its first reversal.
    let amplitude = (4.0_f64.cos() + 0.8).hypot(4.0_f64.sin());
    let run = model.with_declared_parameters().expect("values");
    let inputs = run.default_inputs();
    for solver in GENERAL {
        let motion = run
            .simulate(run.initial_state(), &grid(20.0, 20), &inputs, solver)
            .unwrap_or_else(|error| panic!("{solver}: {error}"));
        let state = &motion.trajectory.final_state;
        assert!(
            (state[0] - (amplitude - 0.8)).abs() < 1e-6,
            "{solver}: {state:?}"
        );
        assert!(state[1].abs() < 1e-9, "{solver}: {state:?}");
        let kinds = motion.event_log(1).into_iter().map(|event| event.kind);
        let expected = [EventKind::Crossing, EventKind::Crossing, EventKind::Stick];
        assert!(kinds.eq(expected), "{solver}: {:?}", motion.event_log(1));
    }
}
