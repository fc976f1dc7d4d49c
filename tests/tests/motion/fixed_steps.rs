//! Tests of `simulate --solver fixed`: order of convergence, held inputs, and rejected models and times.

use eomgen_compiled_model::{CompiledModel, Orders, Request, Solver};
use eomgen_sim::inputs::HeldInputs;
use eomgen_tests::models::{path, project};
use eomgen_tests::program::{run, run_rejected, text};

/// Returns the final state of the double pendulum after 1 s.
fn final_state(solver: Solver, max_step: f64) -> Vec<f64> {
    let model = CompiledModel::load(path("double_pendulum"), Orders::Declared).expect("a model");
    let run = model.with_declared_parameters().expect("an instance");
    let request = Request {
        initial: run.initial_state(),
        times: &[0.0, 1.0],
        inputs: &HeldInputs::zero(0),
        solver,
        tolerance: 1e-13,
        max_step,
        audit: false,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {});
    let motion = motion
        .and_then(|motion| motion.into_complete())
        .expect("a motion");
    assert_eq!(motion.solver, solver);
    motion.trajectory.final_state
}

#[test]
fn fixed_steps_converge_with_order_four() {
    let right = final_state(Solver::Rk, f64::INFINITY);
    let errors = [4e-3, 2e-3, 1e-3].map(|step| {
        let found = final_state(Solver::Fixed, step);
        let errors = found.iter().zip(&right).map(|(a, b)| (a - b).abs());
        errors.fold(0.0, f64::max)
    });
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((15.0..17.0).contains(&ratio), "{errors:?}");
    }
}

#[test]
fn prescribed_motion_and_times_between_steps_are_rejected() {
    let shipped = |name: &str| path(name).display().to_string();
    let regulator = project().join("examples/closed_loop/regulator.toml");
    let regulator = regulator.display().to_string();
    let folder = tempfile::tempdir().expect("a folder");
    let table = folder.path().join("rows.csv");
    let out = table.display().to_string();
    for (spec, options, part) in [
        (
            shipped("crane"),
            "--step 0.01",
            "the input `s` is prescribed motion",
        ),
        (
            shipped("crane"),
            "--step 0.01 --input s=0.1*sin(4*t)",
            "the input `s` is prescribed motion, which cannot be held during a step",
        ),
        (
            shipped("pendulum"),
            "--step 1e-9",
            "the step, 1e-9 s, needs 1.0e9 steps up to the end, but the limit is 2e7",
        ),
        (
            regulator.clone(),
            "--step 1e-9",
            "the step, 1e-9 s, needs 1.0e9 steps up to the end, but the limit is 2e7",
        ),
        (
            shipped("pendulum"),
            "",
            "the solver fixed needs the step size",
        ),
        (shipped("pendulum"), "--step 0", "must be greater than 0"),
        (shipped("pendulum"), "--step nan", "step"),
        (
            shipped("pendulum"),
            "--step 3e-3 --interval 0.01",
            "t = 0.01 s lies between two steps of 0.003 s",
        ),
        (
            shipped("pendulum"),
            "--step 1e7 --interval 0.5",
            "t = 0.5 s lies between two steps of 10000000.0 s",
        ),
        (
            regulator,
            "--step 4e-4 --interval 0.1",
            "t = 0.001 s lies between two steps of 0.0004 s",
        ),
    ] {
        let fixed = [
            "simulate", &spec, "--solver", "fixed", "--until", "1", "--out", &out,
        ];
        let options: Vec<&str> = options.split_whitespace().collect();
        let said = run_rejected(&[&fixed[..], &options].concat());
        assert!(said.contains(part), "{spec}, {options:?}: {said}");
        assert!(!table.exists(), "{spec}");
    }
}

#[test]
fn record_of_a_controlled_input_is_noted() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name).display().to_string();
    std::fs::write(file("one.csv"), "t,u\n0,0.1\n0.1,0.2\n0.2,0\n").expect("a file");
    let dataset = "[records]\ntrain = [\"one.csv\"]\n[time]\ncolumn = \"t\"\nunit = \"s\"\n\
        [inputs.u]\ncolumn = \"u\"\nunit = \"N m\"\nhold = \"zero-order\"\n";
    std::fs::write(file("data.toml"), dataset).expect("a file");
    let regulator = project().join("examples/closed_loop/regulator.toml");
    let regulator = regulator.display().to_string();
    let output = run(&[
        "simulate",
        &regulator,
        "--record",
        &file("data.toml"),
        "--out",
        &file("rows.csv"),
    ]);
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(
        said.contains("a controller drives the input `u`: its column acts only until"),
        "{said}"
    );
}
