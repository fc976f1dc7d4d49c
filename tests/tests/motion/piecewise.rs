//! Tests of nested piecewise functions, which can have whole regions of equilibria: exact solver, general solver, rates
//! and emitted kernels agree.

use std::fmt::Write as _;

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::evaluator::Point;
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::Variant;
use eomgen_compiled_model::{CompiledModel, Instance, Orders, Request, Solver};
use eomgen_model_spec::source::Source;
use eomgen_sim::ode::Trajectory;
use eomgen_sim::piecewise_linear::ExactError;
use eomgen_tests::models::variant;
use eomgen_tests::motions::{TestMotion, difference, grid};
use eomgen_tests::piecewise::machine;
use eomgen_validate::compiler::{self, Compiler, Optimization};
use eomgen_validate::random::Random;

const MAX_DIFFERENCE: f64 = 1e-8;

fn subject(text: &str) -> TestMotion {
    match eomgen_model_spec::check(Source::new("made.toml", text)) {
        Ok(checked) => TestMotion::new(checked.model, 0),
        Err(found) => panic!("{text}\n{}", found.render(false)),
    }
}

/// Compares the exact solver with the general solver and returns the exact motion.
fn compare_and_simulate(subject: &TestMotion, until: f64) -> Trajectory {
    let times = grid(until, 40);
    let exact = subject.simulate_exactly((0.0, until), &times);
    let general = subject.simulate_generally((0.0, until), &times, 1e-12);
    let general = general.expect("a motion without sticking");
    let found = difference(&exact.states, &general.states, 1e-3);
    assert!(found < MAX_DIFFERENCE, "{found:e}");
    exact
}

/// Returns a mass of 0.1 kg under gravity that falls on an elastic floor with the additional force `pad`.
fn ball(pad: &str) -> TestMotion {
    subject(&format!(
        r#"
[model]
name = "ball"
[parameters]
m = {{ value = 0.1, unit = "kg" }}
k = {{ value = 1e5, unit = "N/m" }}
c = {{ value = 10, unit = "N s/m" }}
g = {{ value = 9.81, unit = "m/s^2" }}
[coordinates]
y = {{ unit = "m", initial = 1 }}
[kinetic]
T = "1/2*m*dot(y)^2"
[potential]
V = "m*g*y"
ground = "1/2*k*min(y, 0)^2"
[forces]
pad = {{ on = "y", value = "{pad}" }}
"#
    ))
}

/// Returns a driven mass with this force. All quantities are of order one in SI.
fn driven_mass(force: &str) -> TestMotion {
    subject(&format!(
        r#"
[model]
name = "driven"
[parameters]
m = {{ value = 1, unit = "kg" }}
k = {{ value = 400, unit = "N/m" }}
c = {{ value = 3, unit = "N s/m" }}
F0 = {{ value = 10, unit = "N" }}
F1 = {{ value = 2, unit = "N" }}
b = {{ value = 0.1, unit = "m" }}
v = {{ value = 0.2, unit = "m/s" }}
w = {{ value = 3, unit = "rad/s" }}
[coordinates]
y = {{ unit = "m", initial = 0, initial_rate = 3 }}
[kinetic]
T = "1/2*m*dot(y)^2"
[forces]
f = {{ on = "y", value = "{force}" }}
drive = {{ on = "y", value = "F1*cos(w*t)" }}
"#
    ))
}

#[test]
fn ball_on_floor_defined_by_minimum_matches_general_solver() {
    let pads = [
        "-c*contact(min(y, 0), 0)*dot(y)",
        "c*sign(min(y, 0))*dot(y)",
        "-c*above(-y)*dot(y)",
        "-c*above(abs(y) - y)*dot(y)",
    ];
    for pad in pads {
        let motion = compare_and_simulate(&ball(pad), 2.0);
        let mut times: Vec<f64> = motion.events.iter().map(|event| event.t).collect();
        // Switching functions that coincide change their sign at the same time.
        times.dedup();
        assert_eq!(times.len(), 6, "{pad}");
        assert!(
            (motion.final_state[0] - 0.2426).abs() < 5e-5,
            "{pad}: {}",
            motion.final_state[0]
        );
    }
}

#[test]
fn preloaded_springs_and_one_sided_stops_stay_at_rest() {
    for force in [
        "-F0*sign(deadzone(y, b)) - k*deadzone(y, b)",
        "-k*max(y - b, 0) - c*contact(max(y - b, 0), 0)*dot(y)",
        "-k*y - F0*sign(min(y, b) - b)",
        "-k*y - F0*contact(min(y, b), b)",
        "-k*y - F0*contact(deadzone(max(y, -b), b), 0)",
        "-k*y - F0*sign(max(y, 0)*contact(y, b))",
        "-k*y - F0*sign(max(y - b, 0) + min(y + b, 0))",
        "-k*y - F0*contact(contact(y, b) + above(y), 1)",
        "-k*y - F0*above(y) - c*above(-y)*dot(y)",
    ] {
        let motion = compare_and_simulate(&driven_mass(force), 3.0);
        assert!(motion.events.len() > 1, "{force}");
    }
}

/// Friction that acts only above a given speed can hold the mass at this speed. Steep smooth friction gives nearly the
/// same motion.
#[test]
fn friction_with_a_speed_threshold_holds_the_mass_at_the_threshold() {
    let times = grid(4.0, 40);
    let force = |friction: &str| format!("-{friction} - 0.3*k*y");
    let sudden = driven_mass(&force("F0*sign(deadzone(dot(y), v))"));
    let steep = driven_mass(&force("F0*min(max(deadzone(dot(y), v)/(1e-6*v), -1), 1)"));
    let exact = sudden.simulate_exactly((0.0, 4.0), &times);
    let near = steep.simulate_exactly((0.0, 4.0), &times);
    let apart = difference(&exact.states, &near.states, 1e-3);
    assert!(apart < 1e-4, "{apart:e}");
    let held = exact
        .states
        .iter()
        .filter(|y| (y[1].abs() - 0.2).abs() < 1e-9);
    assert!(held.count() > 1);
    assert!(exact.events.len() < 100, "{}", exact.events.len());
}

/// The sign of an input that is held at zero is zero.
#[test]
fn sign_of_input_held_at_zero_is_zero() {
    let mut subject = subject(
        r#"
[model]
name = "pushed"
[parameters]
m = { value = 2, unit = "kg" }
F = { value = 3, unit = "N" }
[coordinates]
y = { unit = "m" }
[inputs]
u = { unit = "N" }
[kinetic]
T = "1/2*m*dot(y)^2"
[forces]
push = { on = "y", value = "F*sign(u)" }
"#,
    );
    let times = vec![0.0, 1.0, 2.0, 3.0];
    let inputs = eomgen_sim::inputs::HeldInputs::new(times, vec![0.0, 1.0, 0.0, -1.0], 1);
    subject.inputs = inputs.expect("ascending times");
    let motion = subject.simulate_exactly((0.0, 4.0), &[1.0, 2.0, 3.0, 4.0]);
    let rates: Vec<f64> = motion.states.iter().map(|state| state[1]).collect();
    for (found, expected) in rates.iter().zip([0.0, 1.5, 1.5, 0.0]) {
        assert!((found - expected).abs() < 1e-12, "{rates:?}");
    }
}

/// Number of random machines, and numbers of machines that were not compared, by reason.
#[derive(Debug, Default)]
struct Tally {
    machines: usize,
    /// Number of machines for which the side of a switching surface depends on rounding.
    ambiguous: usize,
    /// Number of motions with sticking, which only the exact solver supports.
    held: usize,
    /// Number of machines that the exact solver rejects with a reason.
    refused: usize,
    motions: usize,
    switches: usize,
    /// Number of motions for which the general solver is not accurate enough.
    uncertain: usize,
    rates: usize,
    resting: usize,
    kernels: usize,
    worst_motion: f64,
    worst_rates: f64,
}

/// State of a machine with the number of its regime.
struct Sample {
    t: f64,
    state: Vec<f64>,
    input: f64,
    regime: u32,
    rates: Vec<f64>,
}

fn number(name: &str, otherwise: u64) -> u64 {
    let value = std::env::var(name).ok();
    value.map_or(otherwise, |text| text.parse().expect("a whole number"))
}

/// Number and seed of the machines are the environment variables `EOMGEN_PIECEWISE_COUNT` and `EOMGEN_PIECEWISE_SEED`.
#[test]
fn random_machines_agree_between_solvers_rates_and_kernels() {
    let seed = number("EOMGEN_PIECEWISE_SEED", 16);
    let count = number("EOMGEN_PIECEWISE_COUNT", 20);
    let mut random = Random::new(seed);
    let mut tally = Tally::default();
    let mut emitted = Vec::new();
    for index in 0..count {
        let subject = machine(&mut random, 3);
        tally.machines += 1;
        let place = format!(
            "machine {index} of seed {seed}\n{}",
            subject.model.source.text
        );
        let Some(samples) = samples(&subject, &mut random, &mut tally) else {
            tally.ambiguous += 1;
            continue;
        };
        compare_rates(&subject, &samples, &place, &mut tally);
        compare_motions(&subject, &place, &mut tally);
        emitted.push((emit_kernels(&subject), samples, place));
    }
    for batch in emitted.chunks(25) {
        compare_kernels(batch, &mut tally);
    }
    println!("{tally:?}");
    assert!(2 * tally.motions > tally.machines, "{tally:?}");
    assert!(tally.resting > 0 && tally.switches > 0, "{tally:?}");
}

/// Returns random states with their rates, none of them on a switching surface; `None` if a side depends on rounding.
fn samples(subject: &TestMotion, random: &mut Random, tally: &mut Tally) -> Option<Vec<Sample>> {
    let mut evaluator = variant(&subject.model, 0).evaluator;
    let guards = evaluator.guard_count();
    let mut samples = Vec::new();
    for _ in 0..60 {
        let state: Vec<f64> = (0..4).map(|_| 1.5 * random.symmetric()).collect();
        let t = random.unit();
        let input = random.pick(&[-1.0, 0.0, 0.25, 1.0]).copied()?;
        let inputs = [input];
        let point = |state| Point {
            t,
            state,
            inputs: &inputs,
        };
        let mut values = vec![0.0; guards];
        evaluator.guards(point(&state), &mut values);
        if values
            .iter()
            .any(|value| *value != 0.0 && value.abs() < 1e-13)
        {
            return None;
        }
        tally.resting += usize::from(values.contains(&0.0));
        let bits = values.iter().take(32).enumerate();
        let regime = bits.fold(0, |bits, (k, value)| bits | u32::from(*value > 0.0) << k);
        let mut rates = vec![0.0; 4];
        evaluator.rates(point(&state), &mut rates);
        samples.push(Sample {
            t,
            state,
            input,
            regime,
            rates,
        });
    }
    Some(samples)
}

fn compare_rates(subject: &TestMotion, samples: &[Sample], place: &str, tally: &mut Tally) {
    let mut propagator = subject.propagator().expect("a piecewise linear model");
    for sample in samples {
        let found = propagator.evaluate_rates(sample.t, &sample.state, &[sample.input]);
        let found = found.expect("rates").values;
        let size = sample.rates.iter().fold(1.0, |m: f64, r| m.max(r.abs()));
        for (found, expected) in found.iter().zip(&sample.rates) {
            let off = (found - expected).abs() / size;
            assert!(
                off < MAX_DIFFERENCE,
                "{off:e} at {:?}\n{place}",
                sample.state
            );
            tally.worst_rates = tally.worst_rates.max(off);
        }
        tally.rates += 1;
    }
}

fn compare_motions(subject: &TestMotion, place: &str, tally: &mut Tally) {
    let times = grid(1.2, 24);
    let general = |tolerance| subject.simulate_generally((0.0, 1.2), &times, tolerance);
    let exact = subject.try_simulate_exactly((0.0, 1.2), &times);
    let (coarse, fine) = match (general(1e-11), general(1e-13)) {
        (Ok(coarse), Ok(fine)) => (coarse, fine),
        _ => {
            tally.held += 1;
            return;
        }
    };
    let exact = match exact {
        Ok(exact) => exact,
        Err(ExactError::Sticking { .. }) => {
            tally.refused += 1;
            return;
        }
        Err(error) => panic!("{error}\n{place}"),
    };
    let doubt = difference(&coarse.states, &fine.states, 0.1);
    let found = difference(&exact.states, &fine.states, 0.1);
    if doubt > 0.1 * MAX_DIFFERENCE {
        tally.uncertain += 1;
        assert!(
            found < 10.0 * doubt,
            "difference {found:e}, uncertainty {doubt:e}\n{place}"
        );
        return;
    }
    assert!(found < MAX_DIFFERENCE, "{found:e}\n{place}");
    tally.worst_motion = tally.worst_motion.max(found);
    tally.motions += 1;
    tally.switches += exact.events.len();
}

fn emit_kernels(subject: &TestMotion) -> String {
    let derived = Variant::derive_with(&subject.model, &[], &[Output::Regimes]);
    let program = derived.expect("a model that can be derived").program;
    emit(&program, Packaging::Module).expect("names valid in Rust")
}

type Emitted = (String, Vec<Sample>, String);

/// Compiles the kernels of a batch of machines and compares each with the rates.
fn compare_kernels(batch: &[Emitted], tally: &mut Tally) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let compiler = match Compiler::find(folder.path()) {
        Ok(compiler) => compiler,
        Err(reason) => {
            skips::skip(&reason);
            return;
        }
    };
    let mut source = "#![allow(warnings)]\n".to_owned();
    let mut calls = String::new();
    let mut lines = String::new();
    for (place, (text, samples, _)) in batch.iter().enumerate() {
        writeln!(source, "mod machine_{place} {{\n{text}\n}}").expect("text");
        let mut regimes: Vec<u32> = samples.iter().map(|sample| sample.regime).collect();
        regimes.sort_unstable();
        regimes.dedup();
        writeln!(calls, "{place} => call!(machine_{place}, n, {regimes:?}),").expect("text");
        for sample in samples {
            let numbers = [&[sample.t, sample.input][..], &sample.state].concat();
            let words = numbers.iter().map(|number| number.to_bits().to_string());
            let words: Vec<String> = words.collect();
            writeln!(lines, "{place} {} {}", sample.regime, words.join(" ")).expect("text");
        }
    }
    source += &HARNESS.replace("// calls", &calls);
    let (file, program) = (
        folder.path().join("kernels.rs"),
        folder.path().join("kernels"),
    );
    compiler::write(&file, &source).expect("a file");
    let built = compiler.compile(&file, &program, Optimization::None, &[]);
    let built = built.expect("the compiler ends");
    assert!(built.success, "{}", built.stderr);
    let run = compiler::execute(&program, &lines).expect("the program ends");
    assert!(run.success, "{}", run.stderr);
    let mut found = run.stdout.lines();
    for (_, samples, place) in batch {
        for sample in samples {
            let line = found.next().expect("a line for every state");
            let found = line.split(' ').map(|word| word.parse().expect("bits"));
            let found: Vec<f64> = found.map(f64::from_bits).collect();
            assert_eq!(found, sample.rates, "at {:?}\n{place}", sample.state);
            tally.kernels += 1;
        }
    }
}

const HARNESS: &str = r#"
macro_rules! call {
    ($module:ident, $n:ident, [$($regime:literal),*]) => {{
        let f = |k: usize| f64::from_bits($n[k]);
        let mut inputs = $module::Inputs::default();
        inputs.u = f(3);
        let state = [f(4), f(5), f(6), f(7)];
        let coefficients = $module::Coefficients::prepare(&Default::default());
        let mut rates = [f64::NAN; 4];
        match $n[1] {
            $($regime => $module::rates_in_regime_into::<$regime, _>(
                f(2), &state, &inputs, &coefficients, &mut rates),)*
            _ => {}
        }
        rates
    }};
}

fn main() {
    for line in std::io::stdin().lines() {
        let n: Vec<u64> = line.unwrap().split(' ').map(|word| word.parse().unwrap()).collect();
        let rates: [f64; 4] = match n[0] {
            // calls
            _ => panic!(),
        };
        let words: Vec<String> = rates.iter().map(|rate| rate.to_bits().to_string()).collect();
        println!("{}", words.join(" "));
    }
}
"#;

/// Returns a mass on a spring with a force that depends on the position.
fn mass_with(spring: &str, force: &str) -> CompiledModel {
    let text = format!(
        r#"
[model]
name = "mass"
[parameters]
m = {{ value = 1, unit = "kg" }}
b = {{ value = 0.3, unit = "m" }}
K = {{ value = 200, unit = "N/m" }}
k = {{ value = 500, unit = "N/m" }}
F = {{ value = 20, unit = "N" }}
[coordinates]
x = {{ unit = "m" }}
[kinetic]
T = "1/2*m*dot(x)^2"
[potential]
V = "1/2*k*x^2 + {spring}"
[forces]
push = {{ on = "x", value = "{force}" }}
"#
    );
    CompiledModel::from_text("mass.toml", &text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// The force jumps at the surface of the outer function. Steps must not evaluate the force beyond this surface before
/// they reach it.
#[test]
fn nested_functions_move_as_one_function_at_any_tolerance() {
    let (no_spring, no_force) = ("0*k*x^2", "0*F");
    for (nested, plain) in [
        (
            ("1/2*K*max(x, min(x + 5*b, b))^2", no_force),
            ("1/2*K*max(x, b)^2", no_force),
        ),
        (
            ("F*max(abs(x) - b, 0)", no_force),
            ("F*(max(x - b, 0) + max(-x - b, 0))", no_force),
        ),
        (
            (no_spring, "-F*above(min(x - b, x - b/2))"),
            (no_spring, "-F*above(x - b)"),
        ),
    ] {
        let (spring, force) = nested;
        let [nested, plain] = [nested, plain].map(|(spring, force)| mass_with(spring, force));
        let [nested, plain] =
            [&nested, &plain].map(|model| model.with_declared_parameters().expect("values"));
        let times: Vec<f64> = (0..=20).map(|k| 0.1 * f64::from(k)).collect();
        // With some amplitudes the surface is crossed slowly, which amplifies errors. The machine without nesting has
        // the same errors.
        for amplitude in [-0.300_044_321_32, -0.301, -0.33, -0.5] {
            for (solver, tolerance) in [
                (Solver::Rk, 1e-6),
                (Solver::Rk, 1e-9),
                (Solver::Rk, 1e-12),
                (Solver::Radau, 1e-9),
                (Solver::Adams, 1e-9),
            ] {
                let motion = |run: &Instance<'_>| {
                    let request = Request {
                        initial: &[amplitude, 0.0],
                        times: &times,
                        inputs: &run.default_inputs(),
                        solver,
                        tolerance,
                        max_step: f64::INFINITY,
                        audit: true,
                    };
                    run.simulate_until_stop(&request, &mut |_| {})
                        .expect("a motion")
                };
                let (found, right) = (motion(&nested), motion(&plain));
                let off = difference(&found.trajectory.states, &right.trajectory.states, 1e-3);
                let place = format!("{spring} {force} {amplitude} {solver} {tolerance}");
                assert!(off < 1e4 * tolerance + 1e-7, "{place}: {off:e}");
                let audit = found.audit.expect("an audit");
                assert_eq!(audit.fault_count, 0, "{place}");
            }
        }
    }
}
