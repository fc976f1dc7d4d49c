//! Comparison with closed forms for dry friction on a belt whose speed is a continuous piecewise function of time. The
//! body sticks to the belt while the acceleration of the belt is small enough.

use eomgen_compiled_model::Solver;
use eomgen_tests::motions::{grid, simulate_declared, simulate_to_end};

/// Mass of the body in kg. With the friction of 3 N, its largest acceleration is 1.5 m/s^2.
const MASS: f64 = 2.0;
const FRICTION: f64 = 3.0;

/// Compares the speeds of the body in m/s. The unit of the coordinate is `length` m.
fn compare(belt: &str, expected: impl Fn(f64) -> f64) {
    let times = grid(2.0, 40);
    for (length, solver) in [(1.0, Solver::Rk), (1e3, Solver::Rk), (1e-3, Solver::Radau)] {
        let text = format!(
            r#"[model]
name = "belt"
[parameters]
m = {{ value = {MASS:?}, unit = "kg" }}
F = {{ value = {FRICTION:?}, unit = "N" }}
v = {{ value = 0.6, unit = "m/s" }}
w = {{ value = 1, unit = "1/s" }}
r = {{ value = {length:?}, unit = "m" }}
[coordinates]
x = {{ unit = "1" }}
[definitions]
belt = "{belt}"
[kinetic]
body = "1/2*m*r^2*dot(x)^2"
[forces]
friction = {{ on = "x", value = "-F*r*sign(r*dot(x) - belt)" }}
"#
        );
        let motion = simulate_to_end(&text, &times, solver, (1e-10, f64::INFINITY));
        for (t, state) in times.iter().zip(&motion.trajectory.states) {
            let (found, expected) = (length * state[1], expected(*t));
            assert!(
                (found - expected).abs() < 1e-8,
                "{belt}, {solver}, {length} m, {t} s: {found} {expected}"
            );
        }
    }
}

#[test]
fn body_rests_on_a_belt_that_starts_slowly() {
    compare("v*min(w*t, 1)", |t| 0.6 * t.min(1.0));
}

#[test]
fn body_slides_on_a_fast_starting_belt_and_sticks_later() {
    compare("v*min(5*w*t, 1)", |t| (1.5 * t).min(0.6));
}

#[test]
fn body_rests_on_a_belt_that_returns() {
    compare("v*abs(w*t - 1)", |t| match t {
        // The body accelerates from rest to the decreasing speed of the belt.
        t if t < 0.6 / 2.1 => 1.5 * t,
        t => 0.6 * (t - 1.0).abs(),
    });
}

/// The speed of the belt is written as nested sums and as quotients.
#[test]
fn belt_may_be_written_as_a_nested_sum_or_a_quotient() {
    for belt in [
        "v*min(w*t, 1) - v*max(w*t/2 - 5, 0)",
        "v*(1/2 + min(w*t, 1)) - v/2",
        "v/2*(min(w*t, 1) + min(w*t, 1))",
    ] {
        compare(belt, |t| 0.6 * t.min(1.0));
    }
}

/// The speed of the belt jumps because of a function, a quotient, or the branch cut of an angle.
#[test]
fn jumps_of_a_belt_are_rejected() {
    for belt in [
        "v*sign(t - T)",
        "v*max(t - T, 0)/abs(t - T)",
        "v*atan2(sin(5*w*t), cos(5*w*t))",
    ] {
        let text = format!(
            r#"[model]
name = "belt"
[parameters]
m = {{ value = 2, unit = "kg" }}
F = {{ value = 3, unit = "N" }}
v = {{ value = 0.1, unit = "m/s" }}
w = {{ value = 1, unit = "1/s" }}
T = {{ value = 0.5, unit = "s" }}
[coordinates]
x = {{ unit = "m" }}
[kinetic]
body = "1/2*m*dot(x)^2"
[forces]
friction = {{ on = "x", value = "-F*sign(dot(x) - {belt})" }}
"#
        );
        let settings = (1e-9, f64::INFINITY);
        let motion = simulate_declared(&text, &[0.0, 2.0], Solver::Rk, settings);
        let reason = motion.early_stop.expect("a reason").reason;
        assert!(
            reason.contains("for a speed with a jump"),
            "{belt}: {reason}"
        );
    }
}
