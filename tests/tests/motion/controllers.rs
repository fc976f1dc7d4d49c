//! Comparison of sampled controllers with recursions over the samples, which are exact for piecewise constant inputs.

use eomgen_compiled_model::{CompiledModel, Error, Motion, Orders, Request, Solver};
use eomgen_sim::inputs::HeldInputs;
use eomgen_tests::program::{self, text};

const MASS: &str = r#"
[model]
name = "mass"
[parameters]
m = { value = 2, unit = "kg", min = 0 }
k_p = { value = 30, unit = "N/m" }
k_i = { value = 20, unit = "N/(m s)" }
k_d = { value = 15, unit = "N s/m" }
u_max = { value = 8, unit = "N" }
u_step = { value = 0.25, unit = "N" }
[coordinates]
x = { unit = "m", initial = 0.3 }
[inputs]
r = { unit = "m" }
u = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[forces]
motor = { on = "x", value = "u" }
[observables]
position = "x"
force = "u"
"#;

const PID: &str = r#"
[controllers.pid]
period = { value = 50, unit = "ms" }
states = { e_i = { unit = "m s", next = "e_i + period*(r - position)", initial = 0.01 } }
outputs = { u = "k_p*(r - position) - k_d*dot(x) + k_i*e_i" }
"#;

/// Solvers with the tolerances for the comparison of states.
const SOLVERS: [(Solver, f64); 4] = [
    (Solver::Exact, 1e-10),
    (Solver::Auto, 1e-10),
    (Solver::Rk, 1e-8),
    (Solver::Radau, 1e-7),
];

/// Output interval, in s.
const INTERVAL: f64 = 0.01;
const ROWS: usize = 150;

fn times() -> Vec<f64> {
    (0..=ROWS).map(|row| row as f64 * INTERVAL).collect()
}

/// Simulates with the reference r = 1 m.
fn simulate(text: &str, solver: Solver) -> Result<(CompiledModel, Motion), Error> {
    let model = CompiledModel::from_text("loop.toml", text, Orders::Declared)?;
    let run = model.with_declared_parameters()?;
    let mut inputs = model.default_inputs();
    inputs[0] = 1.0;
    let request = Request {
        initial: run.initial_state(),
        times: &times(),
        inputs: &HeldInputs::constant(inputs),
        solver,
        tolerance: 1e-11,
        max_step: f64::INFINITY,
        audit: true,
    };
    let motion = run
        .simulate_until_stop(&request, &mut |_| {})?
        .into_complete()?;
    Ok((model, motion))
}

/// Mass of 2 kg whose force is constant between changes.
#[derive(Clone, Copy)]
struct Mass {
    t: f64,
    x: f64,
    v: f64,
    u: f64,
}

impl Mass {
    const START: Self = Self {
        t: 0.0,
        x: 0.3,
        v: 0.0,
        u: 0.0,
    };

    fn state_at(&self, t: f64) -> [f64; 2] {
        let (h, a) = (t - self.t, self.u / 2.0);
        [self.x + h * self.v + h * h / 2.0 * a, self.v + h * a]
    }

    fn advance(&mut self, t: f64) {
        [self.x, self.v] = self.state_at(t);
        self.t = t;
    }
}

/// Computes the motion in closed form between changes of the force. `change` is called at each change and returns the
/// time of the next one. Returns the state at every row.
fn follow(mut change: impl FnMut(&mut Mass) -> f64) -> Vec<[f64; 2]> {
    let mut mass = Mass::START;
    let mut next = change(&mut mass);
    let mut rows = Vec::new();
    for t in times() {
        while next <= t + 1e-9 {
            mass.advance(next);
            next = change(&mut mass);
        }
        rows.push(mass.state_at(t));
    }
    rows
}

fn assert_rows(motion: &Motion, expected: &[[f64; 2]], within: f64, what: &str) {
    assert_eq!(motion.trajectory.states.len(), expected.len(), "{what}");
    for (row, (state, right)) in motion.trajectory.states.iter().zip(expected).enumerate() {
        for (found, right) in state.iter().zip(right) {
            assert!(
                (found - right).abs() < within,
                "{what}, row {row}: {state:?}, expected {right}"
            );
        }
    }
}

#[test]
fn pid_on_a_mass_matches_its_recursion_in_every_solver() {
    let mut e_i = 0.01;
    let mut integrals = Vec::new();
    let mut sample = 0.0;
    let expected = follow(|mass| {
        mass.u = 30.0 * (1.0 - mass.x) - 15.0 * mass.v + 20.0 * e_i;
        e_i += 0.05 * (1.0 - mass.x);
        integrals.push(e_i);
        sample += 1.0;
        sample * 0.05
    });
    for (solver, within) in SOLVERS {
        let (model, motion) = simulate(&(MASS.to_owned() + PID), solver).expect("a motion");
        assert_rows(&motion, &expected, within, solver.name());
        assert_eq!(motion.controller_states.names, ["e_i"]);
        let rows = &motion.controller_states.rows;
        for (row, state) in rows.iter().enumerate() {
            // Rows at sample times have the values after the sample.
            let right = integrals[row / 5];
            assert!(
                (state[0] - right).abs() < within,
                "{row}: {state:?}, expected {right}"
            );
        }
        let run = model.with_declared_parameters().expect("an instance");
        let observables = run.observables(&motion).expect("observables");
        let first = 30.0 * 0.7 + 0.2;
        assert!(
            (observables[0][1] - first).abs() < within,
            "{:?}",
            observables[0]
        );
        assert!(
            (observables[4][1] - first).abs() < within,
            "{:?}",
            observables[4]
        );
        assert!(
            (observables[5][1] - first).abs() > 1.0,
            "{:?}",
            observables[5]
        );
    }
}

/// Between two changes, the work of a constant force is its value times the displacement; its jumps at samples do no
/// work.
#[test]
fn energy_audit_of_a_controlled_motion_includes_work_of_the_held_force() {
    let (mut work, mut e_i, mut sample) = (0.0, 0.01, 0.0);
    let (mut before, mut last) = (Mass::START, Mass::START);
    follow(|mass| {
        work += before.u * (mass.x - before.x);
        mass.u = 30.0 * (1.0 - mass.x) - 15.0 * mass.v + 20.0 * e_i;
        e_i += 0.05 * (1.0 - mass.x);
        (before, last) = (*mass, *mass);
        sample += 1.0;
        sample * 0.05
    });
    for (solver, within) in SOLVERS {
        let (_, motion) = simulate(&(MASS.to_owned() + PID), solver).expect("a motion");
        let audit = motion.audit.expect("an audit");
        let found = [audit.work, audit.energy_change];
        for (found, right) in found.into_iter().zip([work, last.v * last.v]) {
            assert!(
                (found - right).abs() < 100.0 * within,
                "{solver}: {audit:?}, expected {right}"
            );
        }
        let nothing = (0, None, 0.0);
        let missed = (
            audit.fault_count,
            &audit.exclusion_reason,
            audit.unaudited_energy,
        );
        assert_eq!(
            missed,
            (nothing.0, &nothing.1, nothing.2),
            "{solver}: {audit:?}"
        );
        assert!(audit.evaluations > 30, "{solver}: {audit:?}");
    }
    let without = simulate(&(MASS.to_owned() + PID), Solver::Fixed);
    assert!(without.is_err() || without.is_ok_and(|(_, motion)| motion.audit.is_none()));
}

/// A controlled mass with a wall and dry friction: some samples are during sticking, others close to impacts.
#[test]
fn energy_audit_of_a_controlled_motion_with_friction_and_impacts_is_silent() {
    let plant = MASS
        .replace("[parameters]\n", "[parameters]\nd = { value = 0.6, unit = \"m\" }\n")
        .replace(
            "[observables]",
            "friction = { on = \"x\", value = \"-u_max/4*sign(dot(x))\" }\n[potential]\nspring = \"1/2*k_p*x^2\"\n\
             [impacts]\nwall = { when = \"d - x\", restitution = 0.6 }\n[observables]",
        );
    for (solver, _) in &SOLVERS[1..] {
        let (_, motion) = simulate(&(plant.clone() + PID), *solver).expect("a motion");
        assert!(!motion.trajectory.events.is_empty());
        let audit = motion.audit.expect("an audit");
        assert_eq!(audit.fault_count, 0, "{solver}: {audit:?}");
        assert!(
            audit.unexplained_energy().abs() < 1e-6,
            "{solver}: {audit:?}"
        );
    }
}

#[test]
fn delayed_offset_quantised_loop_matches_its_recursion() {
    let controller = PID
        .replace(
            "period = ",
            "offset = 0.02\ndelay = { value = 70, unit = \"ms\" }\nperiod = ",
        )
        .replace(
            "\"k_p*(r - position) - k_d*dot(x) + k_i*e_i\"",
            "\"quantise(clamp(k_p*(r - position) - k_d*dot(x) + k_i*e_i, -u_max, u_max), u_step)\"",
        );
    // The delay is longer than the period, so two outputs are pending.
    let mut e_i = 0.01;
    let mut waiting: Vec<(f64, f64)> = Vec::new();
    let (mut sample, mut next) = (0.0, 0.02);
    let mut is_start = true;
    let expected = follow(|mass| {
        if !std::mem::take(&mut is_start) {
            if (mass.t - next).abs() < 1e-9 {
                let wanted: f64 = 30.0 * (1.0 - mass.x) - 15.0 * mass.v + 20.0 * e_i;
                let limited = wanted.clamp(-8.0, 8.0);
                waiting.push((mass.t + 0.07, 0.25 * (limited / 0.25).round()));
                e_i += 0.05 * (1.0 - mass.x);
                sample += 1.0;
                next = 0.02 + 0.05 * sample;
            }
            if let Some((_, force)) = waiting.first().filter(|(t, _)| (mass.t - t).abs() < 1e-9) {
                mass.u = *force;
                waiting.remove(0);
            }
        }
        waiting.first().map_or(next, |(t, _)| t.min(next))
    });
    for (solver, within) in [(Solver::Exact, 1e-10), (Solver::Rk, 1e-8)] {
        let (_, motion) = simulate(&(MASS.to_owned() + &controller), solver).expect("a motion");
        assert_rows(&motion, &expected, within, solver.name());
        for row in 0..2 {
            assert_eq!(motion.trajectory.states[row][0], 0.3);
        }
    }
}

#[test]
fn coincident_samples_use_the_values_before_them() {
    // The times 3*0.1 and 0.3 differ because of rounding. The second controller measures the force before the sample.
    let controllers = r#"
[controllers.fast]
period = 0.1
states = { count = { unit = "1", next = "count + 1" } }
outputs = { u = "2*u_step*(count - 3)" }
[controllers.slow]
period = 0.3
states = { before = { unit = "N", next = "u", initial = "-u_max" }, seen = { unit = "N", next = "before" } }
"#;
    let (_, motion) = simulate(&(MASS.to_owned() + controllers), Solver::Exact).expect("a motion");
    let mut expected = [0.0, -8.0, 0.0];
    let mut force = 0.0;
    for row in 0..=ROWS {
        if row % 10 == 0 {
            let sample = (row / 10) as f64;
            if row % 30 == 0 {
                expected = [expected[0], force, expected[1]];
            }
            force = 0.5 * (sample - 3.0);
            expected[0] = sample + 1.0;
        }
        assert_eq!(motion.controller_states.rows[row], expected, "row {row}");
    }
}

/// Two masses with springs and dampers.
const CHAIN: &str = r#"
[model]
name = "chain"
[parameters]
m = { value = 2, unit = "kg", min = 0 }
k = { value = 30, unit = "N/m" }
c = { value = 0.8, unit = "N s/m" }
g_1 = { value = -9, unit = "N/m" }
g_2 = { value = 25, unit = "N/m" }
g_3 = { value = 2, unit = "N s/m" }
g_4 = { value = 7, unit = "N s/m" }
[coordinates]
x = { unit = "m", initial = 0.2 }
y = { unit = "m", initial = -0.1 }
[inputs]
r = { unit = "m" }
u = { unit = "N" }
[kinetic]
masses = "1/2*m*dot(x)^2 + 1/2*m*dot(y)^2"
[potential]
springs = "1/2*k*x^2 + 1/2*k*(y - x)^2"
[dissipation]
dampers = "1/2*c*dot(x)^2 + 1/2*c*(dot(y) - dot(x))^2"
[forces]
motor = { on = "y", value = "u" }
[controllers.regulator]
period = 0.04
outputs = { u = "-(g_1*x + g_2*y + g_3*dot(x) + g_4*dot(y))" }
"#;

/// Returns exp(a h) of a square matrix by the Taylor series with scaling and squaring.
fn exponential(a: &[Vec<f64>], h: f64) -> Vec<Vec<f64>> {
    let n = a.len();
    let product = |a: &[Vec<f64>], b: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let entry = |i: usize, j: usize| (0..n).map(|k| a[i][k] * b[k][j]).sum();
        (0..n)
            .map(|i| (0..n).map(|j| entry(i, j)).collect())
            .collect()
    };
    let scaled: Vec<Vec<f64>> = (a.iter())
        .map(|row| row.iter().map(|entry| entry * h / 1024.0).collect())
        .collect();
    let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let identity = || (0..n).map(|i| (0..n).map(|j| unit(i, j)).collect::<Vec<f64>>());
    let (mut sum, mut term): (Vec<_>, Vec<_>) = (identity().collect(), identity().collect());
    for order in 1..20 {
        term = product(&term, &scaled);
        term.iter_mut()
            .flatten()
            .for_each(|entry| *entry /= f64::from(order));
        for (sum, term) in sum.iter_mut().flatten().zip(term.iter().flatten()) {
            *sum += term;
        }
    }
    for _ in 0..10 {
        sum = product(&sum, &sum);
    }
    sum
}

#[test]
fn discrete_regulator_matches_a_matrix_recursion() {
    let gains = [-9.0, 25.0, 2.0, 7.0];
    // The state is (x, y, x', y', u), with u' = 0 between samples.
    let (m, k, c) = (2.0, 30.0, 0.8);
    let a = [
        [0.0, 0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0, 0.0],
        [-2.0 * k / m, k / m, -2.0 * c / m, c / m, 0.0],
        [k / m, -k / m, c / m, -c / m, 1.0 / m],
        [0.0; 5],
    ];
    let a: Vec<Vec<f64>> = a.iter().map(|row| row.to_vec()).collect();
    let step = exponential(&a, INTERVAL);
    let mut state = vec![0.2, -0.1, 0.0, 0.0, 0.0];
    let mut expected = Vec::new();
    for row in 0..=ROWS {
        if row % 4 == 0 {
            state[4] = -gains.iter().zip(&state).map(|(g, x)| g * x).sum::<f64>();
        }
        expected.push(state.clone());
        let next = step
            .iter()
            .map(|row| row.iter().zip(&state).map(|(a, x)| a * x).sum());
        state = next.collect();
    }
    for (solver, within) in SOLVERS {
        let (_, motion) = simulate(CHAIN, solver).expect("a motion");
        for (row, (found, right)) in motion.trajectory.states.iter().zip(&expected).enumerate() {
            for (found, right) in found.iter().zip(right) {
                assert!(
                    (found - right).abs() < within,
                    "{solver}, row {row}: {found}, expected {right}"
                );
            }
        }
    }
}

/// Beam with feedback of its first mode.
const BEAM: &str = r#"
[model]
name = "beam"
[parameters]
l = { value = 0.8, unit = "m", min = 0 }
rhoA = { value = 0.42, unit = "kg/m", min = 0 }
EI = { value = 18, unit = "N m^2", min = 0 }
g_1 = { value = 40, unit = "N s/m" }
[inputs]
u = { unit = "N" }
[fields.w]
along = "x"
from = 0
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 3
unit = "m"
[kinetic]
beam = "1/2*integral(rhoA*dot(w)^2, w)"
[potential]
bending = "1/2*integral(EI*diff(w, x, 2)^2, w)"
[forces]
tip = { on = "at(w, l)", value = "u" }
[controllers.damper]
period = 0.001
outputs = { u = "-g_1*dot(q_1)" }
"#;

#[test]
fn single_modes_are_fed_back_and_checked_against_the_order() {
    let model = CompiledModel::from_text("beam.toml", BEAM, Orders::Declared).expect("a model");
    let run = model.with_declared_parameters().expect("an instance");
    let times: Vec<f64> = (0..=200).map(|row| 0.001 * f64::from(row)).collect();
    let initial = [0.01, 0.0, 0.0, 0.0, 0.0, 0.0];
    let none = HeldInputs::zero(1);
    let motion = run
        .simulate(&initial, &times, &none, Solver::Auto)
        .expect("a motion");
    assert_eq!(motion.solver, Solver::Exact);
    let energies = run.observables(&motion).expect("observables");
    let energy = |row: usize| energies[row][energies[row].len() - 2];
    assert!(
        energy(200) < 0.5 * energy(0),
        "{} J of {} J",
        energy(200),
        energy(0)
    );

    let missing = BEAM.replace("q_1", "q_5");
    let error = CompiledModel::from_text("beam.toml", &missing, Orders::Declared);
    let error = error.err().expect("no mode 5");
    let message = error.to_string();
    for part in [
        "beam.toml:27:",
        "no mode `q_5_dot`",
        "the field `w` has 3 modes here",
    ] {
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn output_that_is_not_finite_stops_the_motion_with_its_time() {
    let controller = PID.replace("+ k_i*e_i\"", "+ u_max*sqrt(10.5 - t/period)\"");
    let error = simulate(&(MASS.to_owned() + &controller), Solver::Rk)
        .err()
        .expect("a NaN");
    let message = error.to_string();
    assert!(
        message.contains("at t = 0.55 s the output `u` of the controller `pid` is NaN"),
        "{message}"
    );
}

#[test]
fn period_with_too_many_samples_is_rejected() {
    let controller = PID.replace("value = 50, unit = \"ms\"", "value = 1, unit = \"ps\"");
    assert!(controller.contains("\"ps\""));
    for (solver, _) in SOLVERS {
        let error = simulate(&(MASS.to_owned() + &controller), solver).err();
        let message = error.expect("too many samples").to_string();
        assert!(
            message.contains("1e-12 s, needs 1.5e12 samples up to the end, but the limit is 2e7"),
            "{message}"
        );
    }
}

fn program(arguments: &[&str]) -> (Option<i32>, String) {
    let output = std::process::Command::new(program::path())
        .args(arguments)
        .output()
        .expect("the program");
    let said = text(&output.stdout) + &text(&output.stderr);
    (output.status.code(), said)
}

#[test]
fn commands_simulate_controllers_or_print_a_note() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name).display().to_string();
    let (spec, out) = (file("mass.toml"), file("out"));
    std::fs::write(&spec, MASS.to_owned() + PID).expect("a file");
    let table = file("rows.csv");
    let step = [
        "--input",
        "r=above(t - 0.5)",
        "--until",
        "1.5",
        "--interval",
        "0.01",
    ];
    let simulate = [&["simulate", &spec, "--out", &table][..], &step].concat();
    let (code, said) = program(&[&simulate[..], &["--json"]].concat());
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("\"solver\": \"exact\"") && !said.contains("is not driven"),
        "{said}"
    );
    let rows = std::fs::read_to_string(&table).expect("a table");
    assert!(
        rows.starts_with("t,x,x_dot,position,force,energy,power,e_i\n"),
        "{rows}"
    );
    let number =
        |field: Option<&str>| -> f64 { field.and_then(|f| f.parse().ok()).expect("a number") };
    let last = number(rows.lines().last().expect("a row").split(',').nth(1));
    // A reference that varies with time is measured correctly too.
    let moving = ["--input", "r=0.5*sin(3*t)", "--until", "1.5"];
    let (code, said) = program(&[&["simulate", &spec, "--out", &table][..], &moving].concat());
    assert_eq!(code, Some(0), "{said}");
    let vary = [
        "--vary",
        "m=1:2:2",
        "--measure",
        "final:x",
        "--until",
        "1.5",
    ];
    let sweep = [&["sweep", &spec, "--out", &out][..], &vary, &step[..2]].concat();
    let (code, said) = program(&sweep);
    assert_eq!(code, Some(0), "{said}");
    let swept = std::fs::read_to_string(file("out/sweep.csv")).expect("a table");
    let at_two = number(swept.lines().last().expect("a row").split(',').nth(1));
    assert!((at_two - last).abs() < 1e-12, "{at_two}, {last}");

    let other = file("other");
    for (arguments, what) in [
        (
            vec![
                "sweep",
                &spec,
                "--vary",
                "m=1:2:2",
                "--measure",
                "lyapunov",
                "--until",
                "1",
                "--out",
                &other,
            ],
            "this measure",
        ),
        (
            vec![
                "simulate", &spec, "--input", "u=1", "--until", "1", "--out", &other,
            ],
            "a controller drives the input `u`",
        ),
        (
            vec![
                "simulate", &spec, "--solver", "rk", "--set", "m=0", "--until", "1", "--out",
                &other,
            ],
            "no inertia",
        ),
    ] {
        let (code, said) = program(&arguments);
        assert_eq!(code, Some(2), "{arguments:?}: {said}");
        assert!(said.contains(what), "{arguments:?}: {said}");
    }
    for (arguments, note) in [
        (
            vec!["generate", &spec, "--target", "casadi", "--out", &other],
            "do not sample the controllers",
        ),
        (vec!["linearise", &spec], "are not part of its equations"),
    ] {
        let (code, said) = program(&arguments);
        assert_eq!(code, Some(0), "{arguments:?}: {said}");
        assert_eq!(said.matches(note).count(), 1, "{arguments:?}: {said}");
    }
}
