//! Comparison of simulations with sampled controllers that continue over several calls with uninterrupted simulations.

use eomgen_compiled_model::{
    CompiledModel, Instance, Motion, Orders, Request, Simulation, Solver, SolverOptions,
};
use eomgen_sim::inputs::HeldInputs;
use eomgen_tests::random_numbers::Numbers;

/// Mass on a spring with two controllers. The delay of the first is longer than its period. The force of the second is
/// quantised, with values halfway between two steps. The times 3*0.1 and 0.3 differ because of rounding.
const LOOP: &str = r#"
[model]
name = "mass"
[parameters]
m = { value = 2, unit = "kg", min = 0 }
k = { value = 9, unit = "N/m" }
k_p = { value = 30, unit = "N/m" }
k_d = { value = 6, unit = "N s/m" }
u_step = { value = 0.25, unit = "N" }
[coordinates]
x = { unit = "m", initial = 0.3 }
[inputs]
r = { unit = "m" }
u = { unit = "N" }
v = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[forces]
motor = { on = "x", value = "u" }
brake = { on = "x", value = "v" }
[observables]
position = "x"
[controllers.slow]
period = 0.1
delay = 0.25
states = { e_i = { unit = "m s", next = "e_i + period*(r - position)", initial = 0.01 } }
outputs = { u = "quantise(k_p*(r - position) + k*e_i/period/10, u_step)" }
[controllers.fast]
period = 0.3
offset = 0.1
states = { count = { unit = "1", next = "count + 1" } }
outputs = { v = "quantise((count - 2)*u_step/2, u_step) - k_d*dot(x)" }
"#;

/// Mass that sticks by friction between the changes of its controller's output.
const HELD: &str = r#"
[model]
name = "block"
[parameters]
m = { value = 1.5, unit = "kg", min = 0 }
f = { value = 3, unit = "N", min = 0 }
k_p = { value = 25, unit = "N/m" }
k_d = { value = 4, unit = "N s/m" }
[coordinates]
x = { unit = "m" }
[inputs]
r = { unit = "m" }
u = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[forces]
drive = { on = "x", value = "u" }
friction = { on = "x", value = "-f*sign(dot(x))" }
[controllers.servo]
period = 0.07
delay = 0.01
states = { last = { unit = "m", next = "x" } }
outputs = { u = "k_p*(r - x) - k_d*(x - last)/period" }
"#;

fn derive(text: &str) -> CompiledModel {
    CompiledModel::from_text("loop.toml", text, Orders::Declared).expect("a model")
}

fn options(solver: Solver) -> SolverOptions {
    SolverOptions {
        solver,
        tolerance: 1e-11,
        max_step: if solver == Solver::Fixed {
            0.005
        } else {
            f64::INFINITY
        },
    }
}

fn constant(r: f64, model: &CompiledModel) -> HeldInputs {
    let mut inputs = vec![0.0; model.program().inputs.len()];
    inputs[0] = r;
    HeldInputs::constant(inputs)
}

fn simulate_uninterrupted(
    run: &Instance<'_>,
    times: &[f64],
    inputs: &HeldInputs,
    solver: Solver,
) -> Motion {
    let SolverOptions {
        tolerance,
        max_step,
        ..
    } = options(solver);
    let request = Request {
        initial: run.initial_state(),
        times,
        inputs,
        solver,
        tolerance,
        max_step,
        audit: false,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {});
    let motion = motion.and_then(Motion::into_complete);
    motion.expect("a motion")
}

fn assert_row(simulation: &Simulation<'_>, motion: &Motion, row: usize, within: f64, what: &str) {
    let state = &motion.trajectory.states[row];
    let controlled = &motion.controller_states.rows[row];
    let found = simulation.state().iter().zip(state);
    let sampled = simulation.controller_states();
    assert_eq!(sampled.len(), controlled.len(), "{what}");
    for (found, right) in found.chain(sampled.iter().zip(controlled)) {
        assert!(
            (found - right).abs() < within,
            "{what}, row {row}: {found}, expected {right}"
        );
    }
    let t = motion.trajectory.times[row];
    assert_eq!(simulation.time(), t, "{what}");
    let inputs = motion.inputs.evaluate(t);
    for (found, right) in simulation.inputs().iter().zip(&*inputs) {
        assert!(
            (found - right).abs() < 1e3 * within,
            "{what}, row {row}: {found}, expected {right}"
        );
    }
}

#[test]
fn calls_that_end_anywhere_give_the_motion_of_simulate() {
    let mut random = Numbers(83);
    for (text, solvers) in [
        (
            LOOP,
            &[Solver::Exact, Solver::Rk, Solver::Radau, Solver::Fixed][..],
        ),
        (HELD, &[Solver::Auto, Solver::Rk, Solver::Radau]),
    ] {
        let model = derive(text);
        let run = model.with_declared_parameters().expect("an instance");
        // Calls end at samples, between them, and one floating-point number before or after them.
        let mut times: Vec<f64> = (0..=40).map(|k| f64::from(k) * 0.1).collect();
        times.extend((1..20).map(|k| f64::from(k) * 0.07));
        times.extend((1..20).map(|k| (f64::from(k) * 0.07).next_up()));
        times.extend((0..60).map(|_| 2.0 + 1.9 * random.symmetric()));
        for &solver in solvers {
            let mut times = times.clone();
            if solver == Solver::Fixed {
                times.retain(|t| (t / 0.005 - (t / 0.005).round()).abs() < 1e-9);
            }
            times.sort_by(f64::total_cmp);
            times.dedup();
            let inputs = constant(0.5, &model);
            let motion = simulate_uninterrupted(&run, &times, &inputs, solver);
            let within = match solver {
                Solver::Exact => 1e-11,
                Solver::Fixed => f64::MIN_POSITIVE,
                _ => 1e-8,
            };
            let start = (0.0, run.initial_state());
            let begun = run.start_simulation(start, inputs, options(solver));
            let mut simulation = begun.expect("a simulation");
            assert_eq!(
                simulation.controller_state_names(),
                motion.controller_states.names
            );
            for (row, t) in times.iter().enumerate() {
                simulation.advance(*t).expect("an advance");
                let what = format!("{} by {solver}", model.model().name);
                assert_row(&simulation, &motion, row, within, &what);
            }
            assert_eq!(simulation.solver(), motion.solver);
            let largest = motion.trajectory.states.iter().map(|state| state[0]);
            assert!(largest.fold(0.0, f64::max) > 0.4);
        }
    }
}

#[test]
fn inputs_set_between_calls_act_as_held_inputs_of_simulate() {
    let model = derive(LOOP);
    let run = model.with_declared_parameters().expect("an instance");
    // Calls end at samples and between them.
    let times: Vec<f64> = (0..=80).map(|k| f64::from(k) * 0.05).collect();
    let value = |row: usize| [0.5, -0.2, 0.9, 0.1][row / 7 % 4];
    let rows = (0..times.len()).flat_map(|row| [value(row), 0.0, 0.0]);
    let held = HeldInputs::new(times.clone(), rows.collect(), 3).expect("inputs");
    for solver in [Solver::Exact, Solver::Rk, Solver::Fixed] {
        let motion = simulate_uninterrupted(&run, &times, &held, solver);
        let start = (0.0, run.initial_state());
        let begun = run.start_simulation(start, constant(0.5, &model), options(solver));
        let mut simulation = begun.expect("a simulation");
        for (row, t) in times.iter().enumerate() {
            simulation.advance(*t).expect("an advance");
            let mut inputs = simulation.inputs().to_vec();
            inputs[0] = value(row);
            simulation.set_inputs(&inputs).expect("inputs");
            assert_row(&simulation, &motion, row, 1e-8, solver.name());
        }
    }
}

#[test]
fn simulation_rejects_values_of_driven_inputs_and_keeps_controllers_at_another_state() {
    let model = derive(LOOP);
    let run = model.with_declared_parameters().expect("an instance");
    let start = (0.0, run.initial_state());
    let begun = run.start_simulation(start, constant(0.5, &model), options(Solver::Rk));
    let mut simulation = begun.expect("a simulation");
    simulation.advance(0.45).expect("an advance");
    let (inputs, states) = (simulation.inputs().to_vec(), simulation.controller_states());
    let error = simulation.set_inputs(&[0.5, 1.0, inputs[2]]);
    let message = error.expect_err("a driven input").to_string();
    assert!(
        message.contains("a controller drives the input `u`"),
        "{message}"
    );
    simulation.set_state(&[-1.0, 0.0]).expect("a state");
    assert_eq!(simulation.controller_states(), states);
    assert_eq!(simulation.inputs(), inputs);
    simulation.advance(0.5).expect("an advance");
    let e_i = states[0] + 0.1 * (0.5 - simulation.state()[0]);
    assert!((simulation.controller_states()[0] - e_i).abs() < 1e-12);
    // Outputs keep their delay: the outputs of the sample at 0.3 s act at 0.55 s.
    let before = simulation.inputs()[1];
    simulation.advance(0.54).expect("an advance");
    assert_eq!(simulation.inputs()[1], before);
    simulation.advance(0.55).expect("an advance");
    assert_ne!(simulation.inputs()[1], before);
}

#[test]
fn failing_sample_stops_every_call_until_it_can_be_taken() {
    let failing = LOOP.replace("v = \"", "v = \"u_step*sqrt(r/(0.5*pi))*0 + ");
    let failing = failing.replace("(0.5*pi)", "position");
    let model = derive(&failing);
    let run = model.with_declared_parameters().expect("an instance");
    let start = (0.0, run.initial_state());
    let begun = run.start_simulation(start, constant(0.5, &model), options(Solver::Rk));
    let mut simulation = begun.expect("a simulation");
    simulation.advance(0.05).expect("an advance");
    let mut inputs = simulation.inputs().to_vec();
    inputs[0] = -0.5;
    simulation.set_inputs(&inputs).expect("inputs");
    for _ in 0..2 {
        let error = simulation.advance(1.0).expect_err("a NaN").to_string();
        assert!(
            error.contains("at t = 0.1 s the output `v` of the controller `fast` is NaN"),
            "{error}"
        );
        assert_eq!(simulation.time(), 0.1);
        // The first controller was sampled once.
        let e_i = 0.01 + 0.1 * 0.2 + 0.1 * (-0.5 - simulation.state()[0]);
        let states = simulation.controller_states();
        assert!((states[0] - e_i).abs() < 1e-12 && states[1] == 0.0);
    }
    inputs[0] = 0.5;
    simulation.set_inputs(&inputs).expect("inputs");
    simulation.advance(0.2).expect("an advance");
    assert_eq!(simulation.controller_states()[1], 1.0);
}
