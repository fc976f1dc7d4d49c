//! Comparison of simulations that continue over several calls with uninterrupted simulations.

use std::path::Path;

use eomgen_compiled_model::{CompiledModel, Instance, Orders, Request, Solver, SolverOptions};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::Trajectory;
use eomgen_tests::random_numbers::Numbers;

/// Machine, end of the simulation (s) and the solvers that support it.
struct Case {
    path: &'static str,
    end: f64,
    solvers: &'static [Solver],
}

const GENERAL: &[Solver] = &[Solver::Rk, Solver::Radau];
const ALL: &[Solver] = &[Solver::Exact, Solver::Rk, Solver::Radau];

/// Cases: play, sticking friction, impacts, closed contacts with friction, constraints, and a smooth machine.
const CASES: [Case; 6] = [
    Case {
        path: "model-spec/models/planetary_arm_rig.toml",
        end: 0.05,
        solvers: &[Solver::Exact, Solver::Rk],
    },
    Case {
        path: "model-spec/models/emps.toml",
        end: 0.5,
        solvers: ALL,
    },
    Case {
        path: "examples/impacts/bouncing_ball.toml",
        end: 1.5,
        solvers: GENERAL,
    },
    Case {
        path: "examples/impacts/dropped_box.toml",
        end: 0.8,
        solvers: GENERAL,
    },
    Case {
        path: "examples/constrained/flexible_coupler.toml",
        end: 1.0,
        solvers: GENERAL,
    },
    Case {
        path: "model-spec/models/pendulum.toml",
        end: 3.0,
        solvers: GENERAL,
    },
];

fn load(case: &Case) -> CompiledModel {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    CompiledModel::load(root.join(case.path), Orders::Declared).expect(case.path)
}

/// Block with dry friction.
const BLOCK: &str = r#"
[model]
name = "block"
[parameters]
m = { value = 2.0, unit = "kg" }
f = { value = 15.0, unit = "N" }
[coordinates]
x = { unit = "m" }
[inputs]
F = { unit = "N" }
[kinetic]
block = "1/2*m*dot(x)^2"
[forces]
drive = { on = "x", value = "F" }
friction = { on = "x", value = "-f*sign(dot(x))" }
"#;

/// Block with dry friction between two walls.
const HAMMER: &str = r#"
[model]
name = "hammer"
[parameters]
m = { value = 2.0, unit = "kg" }
f = { value = 15.0, unit = "N" }
e = { value = 0.5, unit = "1" }
b = { value = 0.01, unit = "m" }
[coordinates]
x = { unit = "m" }
[inputs]
F = { unit = "N" }
[kinetic]
block = "1/2*m*dot(x)^2"
[forces]
drive = { on = "x", value = "F" }
friction = { on = "x", value = "-f*sign(dot(x))" }
[impacts]
right = { when = "b - x", restitution = "e" }
left = { when = "b + x", restitution = "e" }
"#;

/// Returns times that divide a motion into calls of very different lengths.
fn call_ends(random: &mut Numbers, end: f64) -> Vec<f64> {
    let mut ends: Vec<f64> = (0..40)
        .map(|_| end * random.symmetric().abs().powi(3))
        .collect();
    ends.push(end);
    ends.sort_by(f64::total_cmp);
    ends
}

fn simulate_uninterrupted(
    run: &Instance<'_>,
    solver: Solver,
    times: &[f64],
    inputs: &HeldInputs,
) -> Trajectory {
    let request = Request {
        initial: run.initial_state(),
        times,
        inputs,
        solver,
        tolerance: 1e-10,
        max_step: f64::INFINITY,
        audit: false,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {});
    let motion = motion.expect("a motion").into_complete();
    motion.expect("a whole motion").trajectory
}

fn options(solver: Solver) -> SolverOptions {
    SolverOptions {
        solver,
        tolerance: 1e-10,
        ..SolverOptions::default()
    }
}

/// Asserts that states agree within a fraction of the largest magnitude of each entry.
fn assert_equal(found: &[Vec<f64>], wanted: &[Vec<f64>], fraction: f64, of: &str) {
    let entries = wanted[0].len();
    let size = |entry: usize| wanted.iter().map(|y| y[entry].abs()).fold(1e-9, f64::max);
    let sizes: Vec<f64> = (0..entries).map(size).collect();
    for (place, (found, wanted)) in found.iter().zip(wanted).enumerate() {
        for entry in 0..entries {
            let difference = (found[entry] - wanted[entry]).abs() / sizes[entry];
            assert!(
                difference < fraction,
                "{of}: sample {place}, entry {entry}: {} instead of {}",
                found[entry],
                wanted[entry]
            );
        }
    }
}

#[test]
fn calls_of_any_length_give_the_motion_of_one_simulation() {
    let mut random = Numbers(71);
    for case in &CASES {
        let compiled = load(case);
        let run = compiled.with_declared_parameters().expect("an instance");
        for &solver in case.solvers {
            let ends = call_ends(&mut random, case.end);
            let times = [&[0.0], &ends[..]].concat();
            let wanted = simulate_uninterrupted(&run, solver, &times, &run.default_inputs());
            let start = (0.0, run.initial_state());
            let mut simulation = run
                .start_simulation(start, run.default_inputs(), options(solver))
                .expect("a simulation");
            let mut states = vec![simulation.state().to_vec()];
            for end in &ends {
                simulation.advance(*end).expect("an advance");
                assert!((simulation.time() - end).abs() < 1e-12 * case.end);
                states.push(simulation.state().to_vec());
            }
            let of = format!("{} by {solver}", case.path);
            assert_equal(&states, &wanted.states, 1e-6, &of);
            let events = simulation.events().len();
            assert!(
                events.abs_diff(wanted.events.len()) <= 1,
                "{of}: {events} events"
            );
        }
    }
}

#[test]
fn inputs_changed_between_calls_act_like_held_inputs() {
    let mut random = Numbers(72);
    for (text, solvers) in [(BLOCK, ALL), (HAMMER, GENERAL)] {
        let compiled = CompiledModel::from_text("machine.toml", text, Orders::Declared);
        let compiled = compiled.expect("a machine");
        let run = compiled.with_declared_parameters().expect("an instance");
        let times: Vec<f64> = (0..=50).map(|k| 0.05 * f64::from(k)).collect();
        let amplitude = |place: usize| if place % 10 < 4 { 40.0 } else { 12.0 };
        let values = (0..times.len()).map(|place| amplitude(place) * random.symmetric());
        let values: Vec<f64> = values.collect();
        let held = HeldInputs::new(times.clone(), values.clone(), 1).expect("inputs");
        for &solver in solvers {
            let wanted = simulate_uninterrupted(&run, solver, &times, &held);
            let start = (0.0, run.initial_state());
            let first = HeldInputs::constant(vec![values[0]]);
            let mut simulation = run
                .start_simulation(start, first, options(solver))
                .expect("a simulation");
            let mut states = vec![simulation.state().to_vec()];
            for (value, end) in values.iter().zip(&times[1..]) {
                simulation.set_inputs(&[*value]).expect("inputs");
                simulation.advance(*end).expect("an advance");
                states.push(simulation.state().to_vec());
            }
            let of = format!("{} by {solver}", run.model().model().name);
            let held_rows = wanted.states.windows(2).filter(|rows| rows[0] == rows[1]);
            assert!(held_rows.count() > 3, "{of} rests at times");
            assert_equal(&states, &wanted.states, 1e-8, &of);
        }
    }
}

/// The force on a mass is constant between its jumps, so that no error estimate limits a step.
#[test]
fn states_within_steps_without_error_have_no_rounding_error() {
    let text = "[model]\nname = \"mass\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n[coordinates]\n\
                x = { unit = \"m\" }\n[inputs]\nu = { unit = \"N\" }\n[kinetic]\nt = \"1/2*m*dot(x)^2\"\n\
                [forces]\nf = { on = \"x\", value = \"u\" }\n";
    let compiled = CompiledModel::from_text("mass.toml", text, Orders::Declared).expect("a model");
    let run = compiled.with_declared_parameters().expect("an instance");
    for solver in [Solver::Rk, Solver::Radau, Solver::Adams] {
        for calls_per_jump in [1, 3, 10] {
            let start = (0.0, run.initial_state());
            let rest = HeldInputs::constant(vec![0.0]);
            let mut simulation = run
                .start_simulation(start, rest, options(solver))
                .expect("a simulation");
            simulation.advance(1000.0).expect("an advance");
            let (interval, mut wanted) = (0.01, [0.0, 0.0]);
            for call in 0..200 {
                let force = if call / calls_per_jump % 2 == 0 {
                    1.0
                } else {
                    -1.0
                };
                simulation.set_inputs(&[force]).expect("inputs");
                let until = 1000.0 + interval * f64::from(call + 1);
                simulation.advance(until).expect("an advance");
                wanted[0] += interval * wanted[1] + 0.5 * interval * interval * force;
                wanted[1] += interval * force;
                let error = (simulation.state()[0] - wanted[0]).abs();
                assert!(
                    error < 1e-12,
                    "{solver}, {calls_per_jump} calls, call {call}: {error:.1e} m"
                );
            }
        }
        let times: Vec<f64> = (0..200).map(|k| 1000.0 + 0.01 * f64::from(k)).collect();
        let times = [&[0.0], &times[..]].concat();
        let jump = HeldInputs::new(vec![0.0, 1000.0, 3000.0], vec![0.0, 1.0, 1.0], 1);
        let motion = simulate_uninterrupted(&run, solver, &times, &jump.expect("inputs"));
        for (t, state) in times.iter().zip(&motion.states).skip(1) {
            let error = (state[0] - 0.5 * (t - 1000.0).powi(2)).abs();
            assert!(error < 5e-13, "{solver}, {t} s: {error:.1e} m");
        }
    }
}

#[test]
fn short_calls_keep_the_steps_of_the_solver() {
    let case = &CASES[5];
    let compiled = load(case);
    let run = compiled.with_declared_parameters().expect("an instance");
    let start = (0.0, run.initial_state());
    let mut simulation = run
        .start_simulation(start, run.default_inputs(), options(Solver::Rk))
        .expect("a simulation");
    let mut all = Trajectory::default();
    for call in 1..=3000 {
        let until = case.end * f64::from(call) / 3000.0;
        let stopped = simulation.advance_through((until, &[until]), &mut all, &mut |_| {});
        assert!(stopped.expect("an advance").is_none());
    }
    let times = [&[0.0], &all.times[..]].concat();
    let wanted = simulate_uninterrupted(&run, Solver::Rk, &times, &run.default_inputs());
    let (found, one) = (all.statistics, wanted.statistics);
    assert!(found.steps <= one.steps + 2, "{found:?} instead of {one:?}");
    assert!(
        found.evaluations <= one.evaluations + 20,
        "{found:?} instead of {one:?}"
    );
    assert_equal(&all.states, &wanted.states[1..], 1e-8, "pendulum");
}

#[test]
fn calls_with_invalid_requests_change_nothing() {
    let compiled = load(&CASES[1]);
    let run = compiled.with_declared_parameters().expect("an instance");
    let start = (0.0, run.initial_state());
    let infinite = HeldInputs::constant(vec![f64::INFINITY]);
    let refused = run.start_simulation(start, infinite, SolverOptions::default());
    let refused = refused.err().expect("an infinite input").to_string();
    assert!(
        refused.contains("the input `force` is infinite"),
        "{refused}"
    );
    let mut simulation = run
        .start_simulation(start, run.default_inputs(), SolverOptions::default())
        .expect("a simulation");
    simulation.advance(0.5).expect("an advance");
    let before = simulation.state().to_vec();
    for until in [0.4, f64::NAN, f64::INFINITY] {
        let error = simulation.advance(until).expect_err("an invalid time");
        assert!(error.to_string().contains("reached 0.5 s"), "{error}");
    }
    let error = simulation
        .set_inputs(&[f64::NAN])
        .expect_err("not a number");
    assert!(
        error.to_string().contains("at t = 0.5 s the input"),
        "{error}"
    );
    assert!(simulation.set_inputs(&[1.0, 2.0]).is_err());
    assert!(simulation.set_state(&[f64::NAN; 2]).is_err());
    assert_eq!(simulation.state(), before);
    simulation.advance(0.5).expect("no advance");
    simulation.advance(0.6).expect("an advance");
}
