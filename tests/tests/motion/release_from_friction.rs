//! Tests of the exact solver: steps of inputs shortly after the breakaway from dry friction, and motions with friction
//! whose equations are chains of integrators. Motions are compared with closed forms and with the general solver.

use eomgen_compiled_model::{CompiledModel, Motion, Orders, Request, Solver};
use eomgen_sim::inputs::HeldInputs;
use eomgen_validate::random::Random;

fn simulate(text: &str, solver: Solver, times: &[f64], inputs: &HeldInputs) -> Motion {
    let model = CompiledModel::from_text("machine.toml", text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}"));
    let run = model.with_declared_parameters().expect("an instance");
    let request = Request {
        initial: run.initial_state(),
        times,
        inputs,
        solver,
        tolerance: 1e-12,
        max_step: f64::INFINITY,
        audit: false,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {});
    let motion = motion.and_then(Motion::into_complete);
    motion.unwrap_or_else(|error| panic!("{solver}: {error}\n{text}"))
}

/// Returns the zero of a decreasing function in an interval, by bisection.
fn find_zero(function: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if function(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[test]
fn input_step_after_breakaway_stops_the_motion() {
    const FORCE: f64 = 2.0;
    const FREQUENCY: f64 = 3.0;
    const FRICTION: f64 = 1.0;
    const MASS: f64 = 0.5;
    let text = format!(
        r#"
[model]
name = "block"
[parameters]
m = {{ value = {MASS}, unit = "kg" }}
F = {{ value = {FRICTION}, unit = "N" }}
a = {{ value = {FORCE}, unit = "N" }}
w = {{ value = {FREQUENCY}, unit = "rad/s" }}
[coordinates]
x = {{ unit = "m" }}
[inputs]
u = {{ unit = "N" }}
[kinetic]
T = "1/2*m*dot(x)^2"
[forces]
friction = {{ on = "x", value = "-F*sign(dot(x))" }}
drive = {{ on = "x", value = "a*sin(w*t) + u" }}
"#
    );
    let release = (FRICTION / FORCE).asin() / FREQUENCY;
    // Velocity and position without the input, by integration of a sin(w t) - F.
    let phase = |t: f64| FREQUENCY * t;
    let start = phase(release);
    let velocity = |t: f64| {
        let driven = FORCE / FREQUENCY * (start.cos() - phase(t).cos());
        (driven - FRICTION * (t - release)) / MASS
    };
    let place = |t: f64| {
        let span = t - release;
        let driven =
            FORCE / FREQUENCY * (start.cos() * span - (phase(t).sin() - start.sin()) / FREQUENCY);
        (driven - 0.5 * FRICTION * span * span) / MASS
    };
    for delay in [1e-4, 1e-3, 5e-3, 0.01, 0.02, 0.05] {
        for step in [1.0, 1.3, 1.9] {
            let change = release + delay;
            let slowed = |t: f64| velocity(t) - step * (t - change) / MASS;
            let stop = find_zero(slowed, [change, change + 0.4]);
            let expected = place(stop) - 0.5 * step * (stop - change).powi(2) / MASS;
            let end = stop + 0.02;
            let inputs = HeldInputs::new(vec![0.0, change], vec![0.0, -step], 1).expect("an input");
            let motion = simulate(&text, Solver::Exact, &[0.0, end], &inputs);
            let found = &motion.trajectory.states[1];
            let subject = format!("delay {delay}, step {step}");
            assert!(
                (found[0] - expected).abs() < 1e-13,
                "{subject}: {found:?}, not {expected}"
            );
            assert_eq!(found[1], 0.0, "{subject}");
        }
    }
}

/// Returns two masses on springs, each with dry friction; the friction of the second mass acts on `slip`.
fn draw_machine(random: &mut Random, slip: &str) -> String {
    let mut between = |low: f64, high: f64| low * (high / low).powf(random.unit());
    let [m, n] = [between(0.2, 3.0), between(0.2, 3.0)];
    let (k, a, w) = (between(5.0, 200.0), between(0.5, 6.0), between(1.0, 12.0));
    let [f, g] = [between(0.2, 2.0), between(0.2, 2.0)];
    let x = 0.2 * random.symmetric();
    format!(
        r#"
[model]
name = "masses"
[parameters]
m = {{ value = {m}, unit = "kg" }}
n = {{ value = {n}, unit = "kg" }}
k = {{ value = {k}, unit = "N/m" }}
F = {{ value = {f}, unit = "N" }}
G = {{ value = {g}, unit = "N" }}
a = {{ value = {a}, unit = "N" }}
w = {{ value = {w}, unit = "rad/s" }}
[coordinates]
x = {{ unit = "m", initial = {x} }}
y = {{ unit = "m" }}
[inputs]
u = {{ unit = "N" }}
[kinetic]
T = "1/2*m*dot(x)^2 + 1/2*n*dot(y)^2"
[potential]
V = "1/2*k*(x - y)^2 + 1/2*k*y^2"
[forces]
f = {{ on = "x", value = "-F*sign(dot(x))" }}
g = {{ on = "y", value = "-G*sign({slip})" }}
h = {{ on = "x", value = "a*sin(w*t) + u" }}
"#
    )
}

/// While the second mass moves with the velocity of the first one and exerts no force on it, four states form a chain
/// of integrators.
#[test]
fn random_machines_with_stepped_inputs_match_the_general_solver() {
    let mut random = Random::new(11);
    let times: Vec<f64> = (0..=40).map(|k| 0.05 * f64::from(k)).collect();
    for case in 0..24 {
        let slip = ["dot(y)", "dot(y) - dot(x)"][case % 2];
        let text = draw_machine(&mut random, slip);
        let mut values = vec![0.0];
        while values.len() < times.len() {
            let last = values[values.len() - 1];
            let is_kept = random.unit() < 0.7;
            values.push(if is_kept {
                last
            } else {
                4.0 * random.symmetric()
            });
        }
        let inputs = HeldInputs::new(times.clone(), values, 1).expect("an input");
        let [exact, general] =
            [Solver::Exact, Solver::Rk].map(|solver| simulate(&text, solver, &times, &inputs));
        let rows = exact
            .trajectory
            .states
            .iter()
            .zip(&general.trajectory.states);
        for ((found, expected), t) in rows.zip(&times) {
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-8,
                    "case {case}, t = {t}: {found} {expected}\n{text}"
                );
            }
        }
    }
}

#[test]
fn masses_at_the_end_of_a_chain_of_integrators_match_the_closed_form() {
    // Time constant of a first-order lag, in s. A free mass with constant velocity moves the input of the lag; its
    // output pushes three masses on springs.
    const LAG: f64 = 0.0154;
    const GAIN: f64 = 47.9;
    const PLACE: f64 = 0.656;
    const VELOCITY: f64 = -0.874;
    const MASSES: [f64; 3] = [0.275, 0.739, 0.487];
    let [m, n, o] = MASSES;
    let text = format!(
        r#"
[model]
name = "chain"
[parameters]
m = {{ value = {m}, unit = "kg" }}
n = {{ value = {n}, unit = "kg" }}
o = {{ value = {o}, unit = "kg" }}
T = {{ value = {LAG}, unit = "s" }}
c = {{ value = {GAIN}, unit = "N/m" }}
k = {{ value = 4.61, unit = "N/m" }}
l = {{ value = 104.1, unit = "N/m" }}
h = {{ value = 21.3, unit = "N/m" }}
d = {{ value = 3.41, unit = "N s/m" }}
e = {{ value = 0.0714, unit = "N s/m" }}
f = {{ value = 0.0147, unit = "N s/m" }}
[coordinates]
p = {{ unit = "m", initial = {PLACE}, initial_rate = {VELOCITY} }}
x = {{ unit = "m" }}
y = {{ unit = "m" }}
r = {{ unit = "m" }}
[states]
z = {{ unit = "N", rate = "(c*p - z)/T" }}
[kinetic]
K = "1/2*m*(dot(p)^2 + dot(x)^2) + 1/2*n*dot(y)^2 + 1/2*o*dot(r)^2"
[potential]
V = "1/2*k*(x - y)^2 + 1/2*l*(y - r)^2 + 1/2*h*(x - r)^2"
[dissipation]
D = "1/2*d*(dot(x) - dot(y))^2 + 1/2*e*(dot(y) - dot(r))^2 + 1/2*f*(dot(x) - dot(r))^2"
[forces]
push = {{ on = "r", value = "z" }}
"#
    );
    let times: Vec<f64> = (0..=20).map(|k| 0.1 * f64::from(k)).collect();
    let motion = simulate(&text, Solver::Exact, &times, &HeldInputs::zero(0));
    for (state, t) in motion.trajectory.states.iter().zip(&times) {
        // The lag z = c (p0 - v T + v t) - c (p0 - v T) exp(-t/T) accelerates the centre of mass; the motion is its
        // double integral.
        let offset = PLACE - VELOCITY * LAG;
        let decay = LAG * t + LAG * LAG * (-t / LAG).exp_m1();
        let moment = GAIN * (0.5 * offset * t * t + VELOCITY * t.powi(3) / 6.0 - offset * decay);
        let found: f64 = MASSES.iter().zip(&state[1..]).map(|(m, x)| m * x).sum();
        assert!(
            (found - moment).abs() < 1e-11 * (1.0 + moment.abs()),
            "t = {t}: {found} {moment}"
        );
    }
}
