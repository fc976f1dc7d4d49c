//! Tests of friction opposite to the direction of sliding, -mu m g v/norm(v): stops, rest, release and turns. They
//! compare with closed forms, with scalar friction and with set-valued time stepping.

use eomgen_compiled_model::{CompiledModel, Motion, Request, Solver};

use crate::{GENERAL, compile_text, grid, simulated};

/// A force that slowly exceeds the friction releases a stiff motion; `auto` may change to `radau` for it.
const RELEASING: [Solver; 2] = [Solver::Auto, Solver::Radau];

const MU: f64 = 0.3;
const G: f64 = 9.81;

/// Returns a puck in axes rotated by an angle; `drive` is the expression of a force along x.
fn puck(angle: f64, drive: &str, rate: [f64; 2]) -> CompiledModel {
    let (c, s) = (angle.cos(), angle.sin());
    let along = [c * rate[0] + s * rate[1], c * rate[1] - s * rate[0]];
    compile_text(&format!(
        r#"
[model]
name = "puck"
[parameters]
m = {{ value = 1, unit = "kg" }}
mu = {{ value = {MU}, unit = "1" }}
g = {{ value = {G}, unit = "m/s^2" }}
F = {{ value = 1, unit = "N" }}
w = {{ value = 2, unit = "rad/s" }}
c = {{ value = {c:?}, unit = "1" }}
s = {{ value = {s:?}, unit = "1" }}
[coordinates]
a = {{ unit = "m", initial_rate = {:?} }}
b = {{ unit = "m", initial_rate = {:?} }}
[definitions]
x = "c*a - s*b"
y = "s*a + c*b"
v = "[c*dot(a) - s*dot(b), s*dot(a) + c*dot(b)]"
p = "[x, y]"
[kinetic]
t = "1/2*m*dot(v, v)"
[forces]
friction = {{ on = "p", value = "-mu*m*g*v/norm(v)" }}
drive = {{ on = "x", value = "{drive}" }}
[observables]
x = "x"
y = "y"
"#,
        along[0], along[1]
    ))
}

/// Asserts that the energy never rises between two samples.
fn assert_energy_falls(model: &CompiledModel, settings: &[(&str, f64)], motion: &Motion) {
    let run = model.with_parameters(settings).unwrap();
    let rows = run.observables(motion).unwrap();
    let names = model.observable_names();
    let place = names.iter().position(|name| name == "energy").unwrap();
    for pair in rows.windows(2) {
        let (before, after) = (pair[0][place], pair[1][place]);
        assert!(
            after <= before + 1e-9 * rows[0][place].abs(),
            "{before} {after}"
        );
    }
}

#[test]
fn puck_stops_at_its_closed_form() {
    let stop = 5.0_f64.sqrt() / (MU * G);
    for angle in [0.0, 0.4, 2.0] {
        let model = puck(angle, "0*F", [1.0, 2.0]);
        for solver in GENERAL {
            // One sample is exactly at the stop.
            let mut times = grid(2.0, 20);
            times.insert(8, stop);
            let motion = simulated(&model, &[], &times, solver);
            let switches = &motion.trajectory.events;
            assert_eq!(switches.len(), 1, "{solver}: {switches:?}");
            assert!(
                (switches[0].t - stop).abs() < 1e-9,
                "{solver} {angle}: {switches:?}"
            );
            assert_energy_falls(&model, &[], &motion);
            let run = model.with_parameters(&[]).unwrap();
            let rows = run.observables(&motion).unwrap();
            for (t, row) in times.iter().zip(&rows) {
                let t = t.min(stop);
                let distance = 5.0_f64.sqrt() * t - 0.5 * MU * G * t * t;
                let (x, y) = (distance / 5.0_f64.sqrt(), 2.0 * distance / 5.0_f64.sqrt());
                assert!(
                    (row[0] - x).abs() < 1e-9 && (row[1] - y).abs() < 1e-9,
                    "{solver} {t}"
                );
            }
            let speeds = &motion.trajectory.final_state[2..];
            assert!(speeds.iter().all(|v| v.abs() < 1e-12), "{speeds:?}");
            assert!(motion.trajectory.statistics.steps < 500);
        }
    }
}

#[test]
fn puck_in_space_stops_at_its_closed_form() {
    let text = r#"
[model]
name = "bead"
[parameters]
m = { value = 2, unit = "kg" }
R = { value = 5, unit = "N" }
[coordinates]
x = { unit = "m", initial_rate = 1 }
y = { unit = "m", initial_rate = -2 }
z = { unit = "m", initial_rate = 2 }
[kinetic]
t = "1/2*m*(dot(x)^2 + dot(y)^2 + dot(z)^2)"
[forces]
f = { on = "[x, y, z]", value = "-R*[dot(x), dot(y), dot(z)]/norm([dot(x), dot(y), dot(z)])" }
"#;
    let model = compile_text(text);
    for solver in GENERAL {
        let motion = simulated(&model, &[], &grid(2.0, 20), solver);
        let (stop, distance) = (3.0 * 2.0 / 5.0, 9.0 * 2.0 / (2.0 * 5.0));
        assert!(
            (motion.trajectory.events[0].t - stop).abs() < 1e-9,
            "{solver}"
        );
        let last = &motion.trajectory.final_state;
        for (found, part) in last.iter().zip([1.0 / 3.0, -2.0 / 3.0, 2.0 / 3.0]) {
            assert!((found - part * distance).abs() < 1e-9, "{solver}: {last:?}");
        }
    }
}

#[test]
fn force_from_rest_moves_the_puck_above_the_limit_only() {
    let limit = MU * G;
    for angle in [0.0, 0.7] {
        let model = puck(angle, "F", [0.0, 0.0]);
        for solver in GENERAL {
            for force in [0.5 * limit, 0.999 * limit, 1.001 * limit, 2.0 * limit] {
                let motion = simulated(&model, &[("F", force)], &grid(1.0, 10), solver);
                let run = model.with_parameters(&[("F", force)]).unwrap();
                let rows = run.observables(&motion).unwrap();
                let x = 0.5 * (force - limit).max(0.0);
                let last = &rows[rows.len() - 1];
                assert!(
                    (last[0] - x).abs() < 1e-9 && last[1].abs() < 1e-9,
                    "{solver} {force}: {last:?} {x}"
                );
            }
        }
    }
}

#[test]
fn driven_puck_on_a_line_matches_scalar_friction() {
    let scalar = compile_text(&format!(
        r#"
[model]
name = "sled"
[parameters]
m = {{ value = 1, unit = "kg" }}
F = {{ value = 1, unit = "N" }}
w = {{ value = 2, unit = "rad/s" }}
R = {{ value = {:?}, unit = "N" }}
[coordinates]
x = {{ unit = "m" }}
[kinetic]
t = "1/2*m*dot(x)^2"
[forces]
friction = {{ on = "x", value = "-R*sign(dot(x))" }}
drive = {{ on = "x", value = "F*sin(w*t)" }}
"#,
        MU * G
    ));
    let times = grid(6.0, 60);
    for force in [3.0, 4.0, 9.0] {
        let settings = [("F", force)];
        let expected = simulated(&scalar, &settings, &times, Solver::Rk);
        for angle in [0.0, 0.3] {
            let model = puck(angle, "F*sin(w*t)", [0.0, 0.0]);
            for solver in RELEASING {
                let motion = simulated(&model, &settings, &times, solver);
                let run = model.with_parameters(&settings).unwrap();
                let rows = run.observables(&motion).unwrap();
                let states = &expected.trajectory.states;
                for ((t, row), state) in times.iter().zip(&rows).zip(states) {
                    let off = (row[0] - state[0]).abs().max(row[1].abs());
                    assert!(
                        off < 1e-7,
                        "{solver} {force} {angle} {t}: {row:?} {state:?}"
                    );
                }
            }
        }
    }
}

/// Masses, friction levels, stiffness, positions and speeds of two pucks that a spring connects.
struct Pair {
    masses: [f64; 2],
    levels: [f64; 2],
    stiffness: f64,
    start: [[f64; 2]; 2],
    rates: [[f64; 2]; 2],
}

impl Pair {
    fn model(&self) -> CompiledModel {
        let mut text = format!(
            "[model]\nname = \"pair\"\n[parameters]\nk = {{ value = {:?}, unit = \"N/m\" }}\n",
            self.stiffness
        );
        for puck in 0..2 {
            let (m, level) = (self.masses[puck], self.levels[puck]);
            text += &format!(
                "m{puck} = {{ value = {m:?}, unit = \"kg\" }}\nR{puck} = {{ value = {level:?}, unit = \"N\" }}\n"
            );
        }
        text += "[coordinates]\n";
        for puck in 0..2 {
            for (axis, name) in ["x", "y"].iter().enumerate() {
                let (initial, rate) = (self.start[puck][axis], self.rates[puck][axis]);
                text += &format!(
                    "{name}{puck} = {{ unit = \"m\", initial = {initial:?}, initial_rate = {rate:?} }}\n"
                );
            }
        }
        text += r#"
[definitions]
v0 = "[dot(x0), dot(y0)]"
v1 = "[dot(x1), dot(y1)]"
[kinetic]
t = "1/2*m0*dot(v0, v0) + 1/2*m1*dot(v1, v1)"
[potential]
spring = "1/2*k*((x0 - x1)^2 + (y0 - y1)^2)"
[forces]
f0 = { on = "[x0, y0]", value = "-R0*v0/norm(v0)" }
f1 = { on = "[x1, y1]", value = "-R1*v1/norm(v1)" }
"#;
        compile_text(&text)
    }

    /// Returns the positions after `steps` steps of set-valued time stepping. The friction impulse stays within its
    /// disc and brings the velocity as near to zero as possible.
    fn simulate_by_time_stepping(&self, until: f64, steps: u32) -> Vec<f64> {
        let h = until / f64::from(steps);
        let (mut q, mut v) = (self.start, self.rates);
        for _ in 0..steps {
            let middle: [[f64; 2]; 2] =
                std::array::from_fn(|i| std::array::from_fn(|j| q[i][j] + 0.5 * h * v[i][j]));
            for puck in 0..2 {
                let next: [f64; 2] = std::array::from_fn(|axis| {
                    let pull = self.stiffness * (middle[1 - puck][axis] - middle[puck][axis]);
                    v[puck][axis] + h * pull / self.masses[puck]
                });
                let speed = next[0].hypot(next[1]);
                let most = h * self.levels[puck] / self.masses[puck];
                let kept = if speed > most {
                    1.0 - most / speed
                } else {
                    0.0
                };
                for axis in 0..2 {
                    let after = kept * next[axis];
                    q[puck][axis] += 0.5 * h * (v[puck][axis] + after);
                    v[puck][axis] = after;
                }
            }
        }
        q.concat()
    }
}

#[test]
fn coupled_pucks_match_set_valued_time_stepping() {
    let pair = Pair {
        masses: [1.0, 2.0],
        levels: [1.5, 2.5],
        stiffness: 8.0,
        start: [[0.0, 0.0], [1.0, 0.5]],
        rates: [[1.0, 2.0], [-1.0, 0.5]],
    };
    let model = pair.model();
    for solver in GENERAL {
        let motion = simulated(&model, &[], &grid(6.0, 60), solver);
        assert_energy_falls(&model, &[], &motion);
        let last = &motion.trajectory.final_state;
        assert!(
            last[4..].iter().all(|v| v.abs() < 1e-12),
            "{solver}: {last:?}"
        );
        let off = |steps: u32| {
            let found = pair.simulate_by_time_stepping(6.0, steps);
            let pairs = found.iter().zip([last[0], last[1], last[2], last[3]]);
            pairs.fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()))
        };
        let (coarse, fine) = (off(6_000), off(600_000));
        assert!(
            coarse < 1e-2 && fine < 2e-5,
            "{solver}: {coarse:e} {fine:e}"
        );
    }
}

#[test]
fn random_pairs_agree_between_solvers_and_come_to_rest() {
    let mut state = 0x1234_5678_9abc_def1_u64;
    let mut number = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
    };
    for case in 0..20 {
        let pair = Pair {
            masses: [1.5 + number(), 1.5 + number()],
            levels: [2.0 + number(), 2.0 + number()],
            stiffness: 10.0 + 8.0 * number(),
            start: [[number(), number()], [number(), number()]],
            rates: [[number(), number()], [number(), number()]],
        };
        let model = pair.model();
        let [auto, radau] = RELEASING.map(|solver| simulated(&model, &[], &grid(8.0, 40), solver));
        for motion in [&auto, &radau] {
            assert_energy_falls(&model, &[], motion);
            let speeds = &motion.trajectory.final_state[4..];
            assert!(speeds.iter().all(|v| v.abs() < 1e-12), "{case}: {speeds:?}");
        }
        let ends = auto
            .trajectory
            .final_state
            .iter()
            .zip(&radau.trajectory.final_state);
        let off = ends.fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
        assert!(off < 1e-6, "{case}: {off:e}");
    }
}

/// Friction barely holds a puck on a spring. Near its stop the spring turns the small velocity, which no explicit step
/// resolves within the tolerance.
#[test]
fn puck_that_friction_barely_holds_stops_in_few_steps() {
    let model = compile_text(
        r#"
[model]
name = "puck"
[parameters]
m = { value = 1.8586168902345077, unit = "kg" }
mu = { value = 0.40620128638717146, unit = "1" }
g = { value = 9.81, unit = "m/s^2" }
k = { value = 23.607744266578422, unit = "N/m" }
[coordinates]
x = { unit = "m", initial = 0.33884747408411997, initial_rate = 1.4472385962109475 }
y = { unit = "m", initial = 0.6943440353269055, initial_rate = 1.7542604877065084 }
[definitions]
v = "[dot(x), dot(y)]"
p = "[x, y]"
[kinetic]
body = "1/2*m*dot(v, v)"
[potential]
spring = "1/2*k*(x^2 + y^2)"
[forces]
friction = { on = "p", value = "-mu*m*g*v/norm(v)" }
"#,
    );
    let run = model.with_declared_parameters().unwrap();
    let times = grid(3.0, 10);
    let simulate = |solver, tolerance| {
        let request = Request {
            initial: run.initial_state(),
            times: &times,
            inputs: &run.default_inputs(),
            solver,
            tolerance,
            max_step: f64::INFINITY,
            audit: false,
        };
        let motion = run.simulate_until_stop(&request, &mut |_| {}).unwrap();
        motion.into_complete().unwrap().trajectory
    };
    let reference = simulate(Solver::Radau, 1e-11);
    for solver in GENERAL {
        for tolerance in [1e-6, 1e-7, 1e-8, 1e-9] {
            let found = simulate(solver, tolerance);
            assert_eq!(found.events.len(), 1, "{solver} at {tolerance}");
            assert!(
                found.statistics.evaluations < 20_000,
                "{solver} at {tolerance}: {} evaluations",
                found.statistics.evaluations
            );
            let states = found.states.iter().flatten();
            for (value, expected) in states.zip(reference.states.iter().flatten()) {
                let error = (value - expected).abs();
                assert!(
                    error <= 100.0 * tolerance,
                    "{solver} at {tolerance}: {error}"
                );
            }
        }
    }
}
