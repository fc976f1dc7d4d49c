//! Tests of machines that are at rest most of the time; short events release them, which long steps must not miss.

use std::f64::consts::PI;

use eomgen_compiled_model::Solver;

use super::{GENERAL, compile_text, grid, simulated};

const SHAKEN: &str = r#"
[model]
name = "shaken"
[parameters]
m = { value = 2, unit = "kg" }
F = { value = 3, unit = "N" }
A = { value = 3.02, unit = "N" }
omega = { value = 50, unit = "rad/s" }
[coordinates]
x = { unit = "m" }
[kinetic]
sled = "1/2*m*dot(x)^2"
[forces]
"#;

#[test]
fn force_slightly_above_friction_breaks_away_every_period() {
    let text = format!(
        "{SHAKEN}rubs = {{ on = \"x\", value = \"-F*sign(dot(x))\" }}\n\
         drive = {{ on = \"x\", value = \"A*sin(omega*t)\" }}\n"
    );
    let model = compile_text(&text);
    for (a, omega) in [(3.02_f64, 50.0), (3.003, 50.0), (3.4, 9.0)] {
        let turns = 40;
        let until = 2.0 * PI * f64::from(turns) / omega;
        let first = (3.0 / a).asin() / omega;
        for solver in [Solver::Rk, Solver::Radau, Solver::Exact] {
            let settings = [("A", a), ("omega", omega)];
            let motion = simulated(&model, &settings, &[0.0, until], solver);
            let switches = &motion.trajectory.events;
            // The mass breaks away and sticks twice per period.
            assert_eq!(switches.len(), 4 * turns as usize, "{solver} {a} {omega}");
            for (turn, pair) in switches.chunks(2).enumerate() {
                let away = first + PI / omega * turn as f64;
                assert!(
                    (pair[0].t - away).abs() < 1e-7 * (1.0 + away),
                    "{solver} {a} {turn}"
                );
            }
        }
    }
}

#[test]
fn short_pulses_move_resting_mass() {
    let text =
        format!("{SHAKEN}drive = {{ on = \"x\", value = \"A*above(sin(omega*t) - 0.99)\" }}\n");
    let model = compile_text(&text);
    let (turns, omega) = (40, 50.0_f64);
    let until = 2.0 * PI * f64::from(turns) / omega;
    let each = 3.02 / 2.0 * 2.0 * 0.99_f64.acos() / omega;
    for solver in [Solver::Rk, Solver::Radau, Solver::Exact] {
        let motion = simulated(&model, &[], &[0.0, until], solver);
        let speed = motion.trajectory.final_state[1];
        let wanted = each * f64::from(turns);
        assert!((speed - wanted).abs() < 1e-9, "{solver}: {speed} {wanted}");
    }
}

#[test]
fn relay_switches_until_sliding_mode_then_decays() {
    // For x'' = -F sign(x + tau x') the motion is parabolic between crossings until |x'| < tau F; then x' = -x/tau.
    let text = r#"
[model]
name = "relay"
[parameters]
m = { value = 1, unit = "kg" }
F = { value = 1, unit = "N" }
tau = { value = 0.1, unit = "s" }
[coordinates]
x = { unit = "m", initial = 1 }
[kinetic]
slider = "1/2*m*dot(x)^2"
[forces]
relay = { on = "x", value = "-F*sign(x + tau*dot(x))" }
"#;
    for (tau, start) in [
        (0.1_f64, 1.0_f64),
        (0.1, 0.3),
        (0.5, 1.0),
        (0.02, 0.3),
        (0.3, 0.01),
    ] {
        let model = compile_text(&text.replace("initial = 1", &format!("initial = {start}")));
        let (mut t, mut x, mut v) = (0.0, start, 0.0_f64);
        let mut pieces = vec![(t, x, v, -1.0)];
        let slides_at = loop {
            let a = pieces
                .last()
                .map_or(-1.0, |piece: &(f64, f64, f64, f64)| piece.3);
            // The next crossing satisfies x + tau v + (v + tau a) s + a s^2/2 = 0; after a crossing the root s = 0 is
            // excluded.
            let (b, c) = (
                v + tau * a,
                if pieces.len() > 1 { 0.0 } else { x + tau * v },
            );
            let s = (-b - a.signum() * (b * b - 2.0 * a * c).sqrt()) / a;
            let s = if s > 0.0 {
                s
            } else {
                (-b + a.signum() * (b * b - 2.0 * a * c).sqrt()) / a
            };
            (t, x, v) = (t + s, x + v * s + 0.5 * a * s * s, v + a * s);
            if v.abs() < tau {
                break t;
            }
            pieces.push((t, x, v, -a));
        };
        let wanted = |at: f64| {
            if at >= slides_at {
                let x = x * (-(at - slides_at) / tau).exp();
                return [x, -x / tau];
            }
            let piece = pieces.iter().rev().find(|piece| piece.0 <= at);
            let (t, x, v, a) = *piece.unwrap_or(&pieces[0]);
            let s = at - t;
            [x + v * s + 0.5 * a * s * s, v + a * s]
        };
        for count in [1, 4, 400] {
            let times = grid(20.0, count);
            for solver in GENERAL.into_iter().chain([Solver::Exact]) {
                let motion = simulated(&model, &[("tau", tau)], &times, solver);
                for (t, state) in motion
                    .trajectory
                    .times
                    .iter()
                    .zip(&motion.trajectory.states)
                {
                    for (found, wanted) in state.iter().zip(wanted(*t)) {
                        assert!(
                            (found - wanted).abs() < 1e-7,
                            "{solver} tau {tau} t {t}: {found} {wanted}"
                        );
                    }
                }
            }
        }
    }
}
