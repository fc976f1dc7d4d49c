//! Tests of friction against the direction of sliding in coordinates of a moving frame, in which the kinetic energy has
//! terms linear in the rates. Motions are compared with equations with inertial forces, with a closed form after a
//! Galilean transformation, and with scalar friction.

use eomgen_compiled_model::{CompiledModel, Motion, Orders, Request, Solver};

const SOLVERS: [Solver; 3] = [Solver::Auto, Solver::Rk, Solver::Radau];

const MASS: f64 = 0.4;
const FRICTION: f64 = 1.2;

/// Returns a puck with this kinetic energy and these forces.
fn puck(kinetic: &str, rates: [f64; 2], forces: &[&str]) -> CompiledModel {
    let [along, across] = rates;
    let mut text = format!(
        r#"
[model]
name = "puck"
[parameters]
m = {{ value = {MASS}, unit = "kg" }}
F = {{ value = {FRICTION}, unit = "N" }}
w = {{ value = 1, unit = "rad/s" }}
V = {{ value = 0.7, unit = "m/s" }}
A = {{ value = 0.05, unit = "m" }}
W = {{ value = 9, unit = "rad/s" }}
[coordinates]
a = {{ unit = "m", initial = 0.3, initial_rate = {along} }}
b = {{ unit = "m", initial_rate = {across} }}
[definitions]
v = "[dot(a), dot(b)]"
u = "[dot(a) + V, dot(b)]"
shaken = "a + A*sin(W*t)"
carried = "a + V*t"
[kinetic]
k = "{kinetic}"
[observables]
grip = "F*dot(a)/norm(v)"
slowness = "1/norm(v)"
[forces]
"#
    );
    for (place, force) in forces.iter().enumerate() {
        let (on, value) = force.split_once(':').expect("a coordinate and a value");
        text += &format!("f_{place} = {{ on = \"{on}\", value = \"{value}\" }}\n");
    }
    CompiledModel::from_text("puck.toml", &text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Simulates, asserts the balance of energy and work, and returns the motion.
fn simulate(model: &CompiledModel, solver: Solver) -> Motion {
    let run = model.with_declared_parameters().expect("an instance");
    let times: Vec<f64> = (0..=40).map(|k| 0.05 * f64::from(k)).collect();
    let request = Request {
        initial: run.initial_state(),
        times: &times,
        inputs: &run.default_inputs(),
        solver,
        tolerance: 1e-11,
        max_step: f64::INFINITY,
        audit: true,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {});
    let motion = motion.and_then(Motion::into_complete);
    let motion = motion.unwrap_or_else(|error| panic!("{solver}: {error}"));
    let audit = motion.audit.as_ref().expect("an audit");
    assert_eq!(audit.fault_count, 0, "{solver}: {audit:?}");
    motion
}

/// Asserts that two motions have the same states and events.
fn assert_equal_motions(name: &str, one: &Motion, other: &Motion) {
    let [(one, events), (other, others)] =
        [one, other].map(|motion| (&motion.trajectory.states, &motion.trajectory.events));
    for (row, expected) in one.iter().zip(other) {
        for (found, expected) in row.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-8,
                "{name}: {found} {expected}"
            );
        }
    }
    assert_eq!(events.len(), others.len(), "{name}: {events:?} {others:?}");
    for (event, expected) in events.iter().zip(others) {
        assert!((event.t - expected.t).abs() < 1e-8, "{name}: {event:?}");
    }
}

const AT_REST: &str = "1/2*m*(dot(a)^2 + dot(b)^2)";
const TURNING: &str = "1/2*m*((dot(a) - w*b)^2 + (dot(b) + w*a)^2)";
const SHAKEN: &str = "1/2*m*(dot(shaken)^2 + dot(b)^2)";
const CARRIED: &str = "1/2*m*(dot(carried)^2 + dot(b)^2)";
const DRY: &str = "[a, b]:-F*v/norm(v)";

#[test]
fn friction_in_moving_frames_matches_inertial_forces() {
    let turning = ["a:2*m*w*dot(b) + m*w^2*a", "b:-2*m*w*dot(a) + m*w^2*b"];
    let shaken = ["a:m*A*W^2*sin(W*t)"];
    let growing = "[a, b]:-F*(1 + exp(-(norm(v)/V)^2))*v/norm(v)";
    let frames: [(&str, &str, &[&str]); 3] = [
        ("turning", TURNING, &turning),
        ("shaken", SHAKEN, &shaken),
        ("carried", CARRIED, &[]),
    ];
    for (name, kinetic, inertial) in frames {
        for friction in [DRY, growing, "[a, b]:-F*v/norm(v) - m*W*v/5"] {
            let rates = [0.6, 0.5];
            let framed = puck(kinetic, rates, &[friction]);
            let plain = puck(AT_REST, rates, &[&[friction], inertial].concat());
            for solver in SOLVERS {
                let motions = [&framed, &plain].map(|model| simulate(model, solver));
                assert_equal_motions(name, &motions[0], &motions[1]);
                let held = &motions[0].trajectory;
                assert!(!held.events.is_empty(), "{name}, {solver}");
            }
        }
    }
}

/// If the puck sticks to the turntable, the friction is the centripetal force.
#[test]
fn puck_rests_on_a_turntable() {
    let model = puck(TURNING, [0.6, 0.5], &[DRY]);
    let run = model.with_declared_parameters().expect("an instance");
    for solver in SOLVERS {
        let motion = simulate(&model, solver);
        let last = &motion.trajectory.final_state;
        assert!(last[2..].iter().all(|rate| rate.abs() < 1e-12), "{last:?}");
        let rows = run.observables(&motion).expect("observables");
        let grip = rows.last().expect("rows")[0];
        assert!((grip - MASS * last[0]).abs() < 1e-9, "{solver}: {grip}");
    }
}

/// The friction acts on the ground; the coordinates are those of an observer who moves with the speed V.
#[test]
fn puck_on_the_ground_stops_for_a_moving_observer() {
    let model = puck(CARRIED, [1.3, 0.4], &["[a, b]:-F*u/norm(u)"]);
    let (along, across) = (1.3 + 0.7, 0.4);
    let speed = f64::hypot(along, across);
    let stop = speed * MASS / FRICTION;
    for solver in SOLVERS {
        let motion = simulate(&model, solver);
        let events = &motion.trajectory.events;
        assert_eq!(events.len(), 1, "{solver}: {events:?}");
        assert!((events[0].t - stop).abs() < 1e-9, "{solver}: {events:?}");
        let expected = [
            0.3 + 0.5 * along * stop - 0.7 * 2.0,
            0.5 * across * stop,
            -0.7,
            0.0,
        ];
        for (found, expected) in motion.trajectory.final_state.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-9,
                "{solver}: {found} {expected}"
            );
        }
    }
}

/// In each half period of the oscillating table, the puck sticks and slides.
#[test]
fn straight_motion_on_a_shaken_table_matches_scalar_friction() {
    let vector = puck(SHAKEN, [0.6, 0.0], &[DRY]);
    let scalar = puck(SHAKEN, [0.6, 0.0], &["a:-F*sign(dot(a))"]);
    for solver in SOLVERS {
        let [vector, scalar] = [&vector, &scalar].map(|model| simulate(model, solver));
        for (row, expected) in vector
            .trajectory
            .states
            .iter()
            .zip(&scalar.trajectory.states)
        {
            for (found, expected) in row.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-7,
                    "{solver}: {found} {expected}"
                );
            }
        }
        assert!(vector.trajectory.events.len() > 6, "{solver}");
    }
}
