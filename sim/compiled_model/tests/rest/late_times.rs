//! Tests of motions that begin at a late time, as records with Unix times do, and of late events in a long motion.

use eomgen_compiled_model::{Request, Solver};
use eomgen_sim::inputs::HeldInputs;

use super::{GENERAL, compile_text};

/// Start times, s. The last one is a Unix time, which is rounded to 2.4e-7 s.
const STARTS: [f64; 4] = [0.0, 1e6, 1e8, 1.7e9];

const OSCILLATOR: &str = r#"
[model]
name = "oscillator"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 400, unit = "N/m" }
[coordinates]
x = { unit = "m", initial = 0.2 }
[kinetic]
t = "1/2*m*dot(x)^2"
[potential]
v = "1/2*k*x^2"
"#;

/// Ball that an input pushes off the floor.
const BALL: &str = r#"
[model]
name = "ball"
[parameters]
m = { value = 1, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
h = { value = 0, unit = "m" }
[coordinates]
y = { unit = "m", initial = "h" }
[inputs]
u = { unit = "N" }
[kinetic]
t = "1/2*m*dot(y)^2"
[potential]
v = "m*g*y"
[forces]
push = { on = "y", value = "u" }
[impacts]
floor = { when = "y", restitution = 0.8 }
"#;

/// Returns the height (m) of a ball `after` s after its release from rest at the height `h` (m), with restitution 0.8.
fn bouncing_height(h: f64, after: f64) -> f64 {
    let g = 9.81;
    let mut speed = (2.0 * g * h).sqrt();
    let mut since = after - speed / g;
    if since < 0.0 {
        return h - 0.5 * g * after * after;
    }
    while speed > 1e-9 {
        speed *= 0.8;
        if since < 2.0 * speed / g {
            return speed * since - 0.5 * g * since * since;
        }
        since -= 2.0 * speed / g;
    }
    0.0
}

fn last_position(
    text: &str,
    (settings, inputs): (&[(&str, f64)], &HeldInputs),
    times: &[f64],
    solver: Solver,
) -> f64 {
    let model = compile_text(text);
    let run = model.with_parameters(settings).expect("an instance");
    let request = Request {
        initial: run.initial_state(),
        times,
        inputs,
        solver,
        tolerance: 1e-9,
        max_step: f64::INFINITY,
        audit: false,
    };
    let motion = run
        .simulate_until_stop(&request, &mut |_| {})
        .expect("a motion");
    assert!(motion.early_stop.is_none(), "{solver} from {times:?}");
    motion.trajectory.final_state[0]
}

#[test]
fn oscillator_is_as_accurate_from_a_late_start() {
    for start in STARTS {
        for solver in GENERAL {
            let times = [start, start + 4.0];
            let none = HeldInputs::zero(0);
            let x = last_position(OSCILLATOR, (&[], &none), &times, solver);
            let expected = 0.2 * 80.0_f64.cos();
            assert!((x - expected).abs() < 1e-8, "{solver} from {start}: {x}");
        }
    }
}

#[test]
fn ball_bounces_as_long_from_a_late_start() {
    for start in STARTS {
        // Impacts are located to the rounding of the time; speeds are below 5 m/s.
        let allowed = 1e-8 + 1e2 * f64::EPSILON * start;
        for solver in GENERAL {
            for after in [1.5, 3.0, 3.625] {
                let times = [start, start + after];
                let none = HeldInputs::zero(1);
                let y = last_position(BALL, (&[("h", 1.0)], &none), &times, solver);
                let error = (y - bouncing_height(1.0, after)).abs();
                assert!(
                    error < allowed,
                    "{solver} from {start}, after {after}: {error}"
                );
            }
        }
    }
}

#[test]
fn ball_that_rests_for_long_bounces_after_a_push() {
    for push in [1.0, 1e4, 1e7, 1e8] {
        let rows = vec![0.0, push, push + 0.125];
        let inputs = HeldInputs::new(rows, vec![0.0, 20.0, 0.0], 1).expect("inputs");
        // The push ends at the height 1/2 a t^2 with the speed a t.
        let (a, g) = (20.0 - 9.81, 9.81);
        let (height, speed) = (0.5 * a * 0.125 * 0.125, a * 0.125);
        let top = height + speed * speed / (2.0 * g);
        let expected = bouncing_height(top, 1.375 - speed / g);
        for solver in GENERAL {
            let times = [0.0, push + 1.5];
            let y = last_position(BALL, (&[], &inputs), &times, solver);
            let allowed = 1e-8 + 1e4 * f64::EPSILON * push;
            assert!(
                (y - expected).abs() < allowed,
                "{solver} at {push}: {y} instead of {expected}"
            );
        }
    }
}
