//! Tests of machines with constraints: comparison of motions with published values and with independent coordinates,
//! drift, initial states, and the number of operations per mode.

use std::cell::RefCell;
use std::path::Path;

use eomgen_analysis::constrained_modes::constrained_modes;
use eomgen_codegen::program::evaluator::Point;
use eomgen_compiled_model::{
    CompiledModel, DrivenModel, EquilibriumRequest, Error, EventKind, Orders, Request, Solver,
};
use eomgen_sim::ode::{Settings, simulate};
use eomgen_tests::motions::{grid, simulate_declared};

const ROD: &str = r#"
[model]
name = "rod"

[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.7, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }

[coordinates]
x = { unit = "m", initial = "l" }
y = { unit = "m" }

[kinetic]
load = "1/2*m*(dot(x)^2 + dot(y)^2)"

[potential]
weight = "m*g*y"

[constraints]
rod = { zero = "x^2 + y^2 - l^2" }
"#;

fn compile(text: &str) -> CompiledModel {
    CompiledModel::from_text("constrained.toml", text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn compile_feature(name: &str, orders: Orders<'_>) -> CompiledModel {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/constrained");
    CompiledModel::load(folder.join(format!("{name}.toml")), orders)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn compile_changed(line: &str, by: &str) -> CompiledModel {
    assert!(ROD.contains(line));
    compile(&ROD.replace(line, by))
}

fn simulation_error(model: &CompiledModel) -> String {
    let run = model.with_declared_parameters().unwrap();
    let found = run.simulate(
        run.initial_state(),
        &[0.0, 0.1],
        &run.default_inputs(),
        Solver::Auto,
    );
    match found {
        Err(Error::Request(reason)) => reason,
        other => panic!("not refused: {other:?}"),
    }
}

/// Seven bodies in three loops. The final state is published in the Test Set for IVP Solvers.
#[test]
fn squeezing_mechanism_reaches_published_end_state() {
    let model = compile_feature("squeezing_mechanism", Orders::Declared);
    let run = model.with_declared_parameters().unwrap();
    let published = [
        15.81077119629904,
        -15.75637105984298,
        0.04082224013073101,
        -0.5347301163226948,
        0.5244099658805304,
        0.5347301163226948,
        1.048080741042263,
    ];
    for (solver, tolerance) in [(Solver::Rk, 2e-8), (Solver::Radau, 2e-6)] {
        let motion = run
            .simulate(
                run.initial_state(),
                &[0.0, 0.03],
                &run.default_inputs(),
                solver,
            )
            .unwrap();
        for (found, expected) in motion.trajectory.states[1].iter().zip(published) {
            let error = (found - expected).abs() / expected.abs().max(1.0);
            assert!(error < tolerance, "{solver}: {found} and {expected}");
        }
    }
}

#[test]
fn constrained_rod_matches_angle_and_does_not_drift() {
    let rod = compile(ROD);
    let angle = compile(
        &ROD.replace(
            "x = { unit = \"m\", initial = \"l\" }",
            "theta = { unit = \"rad\" }",
        )
        .replace("y = { unit = \"m\" }\n", "")
        .replace(
            "\n[kinetic]",
            "\n[definitions]\nx = \"l*cos(theta)\"\ny = \"l*sin(theta)\"\n\n[kinetic]",
        )
        .replace("[constraints]\nrod = { zero = \"x^2 + y^2 - l^2\" }\n", ""),
    );
    let times: Vec<f64> = (0..=1000).map(|sample| 0.1 * f64::from(sample)).collect();
    let motion = |model: &CompiledModel, solver| {
        let run = model.with_declared_parameters().unwrap();
        let motion = run
            .simulate(run.initial_state(), &times, &run.default_inputs(), solver)
            .unwrap();
        let observables = run.observables(&motion).unwrap();
        (motion.trajectory.states, observables)
    };
    let (expected, _) = motion(&angle, Solver::Rk);
    for (solver, tolerance) in [(Solver::Rk, 2e-6), (Solver::Radau, 2e-4)] {
        let (states, observables) = motion(&rod, solver);
        let residual = rod
            .observable_names()
            .iter()
            .position(|name| name == "residual_rod")
            .unwrap();
        let lambda = rod
            .observable_names()
            .iter()
            .position(|name| name == "lambda_rod")
            .unwrap();
        for ((state, seen), angle) in states.iter().zip(&observables).zip(&expected) {
            assert!(
                seen[residual].abs() < 1e-10 * 0.49,
                "{solver}: {}",
                seen[residual]
            );
            let along = state[0] * state[2] + state[1] * state[3];
            assert!(along.abs() < 1e-10, "{solver}: {along}");
            let error = (state[0] - 0.7 * angle[0].cos()).abs();
            assert!(error < tolerance, "{solver}: {error}");
            let speed = state[2].powi(2) + state[3].powi(2);
            let pull = 2.0 * speed / 0.7 - 2.0 * 9.81 * state[1] / 0.7;
            assert!((pull + 2.0 * 0.7 * seen[lambda]).abs() < 1e-7, "{solver}");
        }
    }
}

#[test]
fn initial_state_is_projected_onto_constraints_with_a_note() {
    let model = compile_changed(
        "y = { unit = \"m\" }",
        "y = { unit = \"m\", initial = 0.1, initial_rate = 2 }",
    );
    let run = model.with_declared_parameters().unwrap();
    let motion = run
        .simulate(
            run.initial_state(),
            &[0.0, 0.1],
            &run.default_inputs(),
            Solver::Auto,
        )
        .unwrap();
    let start = &motion.trajectory.states[0];
    assert!((start[0].hypot(start[1]) - 0.7).abs() < 1e-15);
    assert!((start[0] * start[2] + start[1] * start[3]).abs() < 1e-14);
    let names: Vec<&str> = motion
        .initial_changes
        .iter()
        .map(|moved| moved.name.as_str())
        .collect();
    assert_eq!(names, ["x", "y", "x_dot", "y_dot"]);
    assert_eq!(
        (
            motion.initial_changes[1].requested,
            motion.initial_changes[1].unit.as_str()
        ),
        (0.1, "m")
    );
    // With equal masses, the projection gives the point of the circle that is nearest to the initial position.
    assert!((start[1] / start[0] - 0.1 / 0.7).abs() < 1e-3);
}

fn derivation_error(constraints: &str) -> String {
    let text = ROD.replace("x^2 + y^2 - l^2", constraints);
    match CompiledModel::from_text("constrained.toml", &text, Orders::Declared) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("{constraints}: derived"),
    }
}

#[test]
fn unsatisfiable_constraints_are_named() {
    let never = derivation_error("x^2 + y^2 + l^2");
    assert!(never.contains("`rod` is never zero"), "{never}");
    assert!(never.contains("is at least 4.900e-1 m^2"), "{never}");
    // Interval bounds of the terms do not exclude a zero of this constraint.
    let never = derivation_error("x^2 + y^2 + l*x + l^2");
    assert!(
        never.contains("`rod` stays at") || never.contains("`rod` has no effect"),
        "{never}"
    );
    let steep = simulation_error(&compile_changed("x^2 + y^2 - l^2", "sqrt((x - l)*l) + y"));
    assert!(
        steep.contains("derivative of the constraint `rod` is not finite"),
        "{steep}"
    );
    let flat = simulation_error(&compile_changed("initial = \"l\"", "initial = 0"));
    assert!(flat.contains("`rod` has no effect"), "{flat}");
}

#[test]
fn contradictory_constraints_are_rejected_with_location() {
    for (first, again, said) in [
        (
            "x^2 + y^2 - l^2",
            "x^2 + y^2 - 4*l^2",
            "`again` contradicts `rod`",
        ),
        (
            "x^2 + y^2 - l^2",
            "2*x^2 + 2*y^2 - l^2",
            "`again` contradicts `rod`",
        ),
        // Linear constraints are dependent in every configuration, so they are detected
        // symbolically.
        ("x - l", "2*x - 3*l", "`again` contradicts `rod`"),
        // Circles without a common point: the least squares solution is between them.
        (
            "x^2 + y^2 - l^2",
            "(x - 3*l)^2 + y^2 - l^2",
            "`again` contradicts `rod`",
        ),
        (
            "(x*x + y*y)/l - l",
            "((x - 1.5*l)^2 + (y + 2*l)^2)/l - l",
            "`again` contradicts `rod`",
        ),
    ] {
        let found = derivation_error(&format!("{first}\" }}\nagain = {{ zero = \"{again}"));
        assert!(found.contains(said) && found.contains("`rod`"), "{found}");
        assert!(found.contains("constrained.toml"), "{found}");
    }
}

#[test]
fn singular_initial_states_are_noted() {
    for (start, constraints) in [
        ("initial = 0", "x^2 + y^2 - l^2"),
        // The curve of the constraint intersects itself at (l, 0).
        ("initial = \"l\"", "(x - l)^2*x - y^2*l"),
    ] {
        let text = ROD
            .replace("initial = \"l\"", start)
            .replace("x^2 + y^2 - l^2", constraints);
        let model = compile(&text);
        let notes = model.redundancy_notes().join("\n");
        assert!(
            notes.contains("the initial state is a singular position")
                && notes.contains("`rod` has no effect"),
            "{constraints}: {notes}"
        );
    }
    assert!(compile(ROD).redundancy_notes().is_empty());
}

/// Returns a parallelogram linkage of two equal cranks. The coupler is as long as the ground
/// between the cranks, and the ground is rotated by `angle`.
fn parallelogram(angle: f64) -> String {
    format!(
        r#"
[model]
name = "parallelogram"
[parameters]
m = {{ value = 1, unit = "kg" }}
a = {{ value = 0.3, unit = "m" }}
b = {{ value = 0.5, unit = "m" }}
g = {{ value = 9.81, unit = "m/s^2" }}
J = {{ value = 0.01, unit = "kg m^2" }}
[coordinates]
phi = {{ unit = "rad", initial = {start} }}
psi = {{ unit = "rad", initial = {start} }}
beta = {{ unit = "rad", initial = {angle} }}
[kinetic]
cranks = "1/2*m*a^2*dot(phi)^2 + 1/2*m*a^2*dot(psi)^2"
coupler = "1/2*J*dot(beta)^2"
[potential]
weight = "m*g*a*(sin(phi - {angle}) + sin(psi - {angle}))"
[constraints]
across = {{ zero = "a*cos(phi) + b*cos(beta) - b*cos({angle}) - a*cos(psi)" }}
up = {{ zero = "a*sin(phi) + b*sin(beta) - b*sin({angle}) - a*sin(psi)" }}
"#,
        start = 1.2 + angle
    )
}

#[test]
fn folding_linkage_stops_and_names_constraints() {
    for (angle, named) in [
        (0.0, "the constraint `across` has no effect"),
        (0.6, "the constraints `across`, `up` depend on each other"),
    ] {
        let model = compile(&parallelogram(angle));
        let run = model.with_declared_parameters().expect("an instance");
        let times: Vec<f64> = (0..=100).map(|k| f64::from(k) * 0.01).collect();
        for solver in [Solver::Rk, Solver::Radau] {
            let request = Request {
                initial: run.initial_state(),
                times: &times,
                inputs: &run.default_inputs(),
                solver,
                tolerance: 1e-9,
                max_step: f64::INFINITY,
                audit: false,
            };
            let motion = run
                .simulate_until_stop(&request, &mut |_| {})
                .expect("a motion");
            let stopped = motion.early_stop.expect("a stop");
            assert!(stopped.reason.contains(named), "{}", stopped.reason);
            assert!(
                stopped.reason.contains("singular position"),
                "{}",
                stopped.reason
            );
            // By conservation of energy, the cranks fall like a single pendulum. The time until the linkage is flat is
            // the integral of 1/rate, with a substitution that makes the integrand smooth.
            let (g, a) = (9.81_f64, 0.3_f64);
            let count = 2000;
            let flat: f64 = (0..count)
                .map(|k| {
                    let u = (f64::from(k) + 0.5) / f64::from(count);
                    let phi = 1.2 * (1.0 - u * u);
                    let rate = (2.0 * g / a * (1.2_f64.sin() - phi.sin())).sqrt();
                    2.0 * 1.2 * u / rate / f64::from(count)
                })
                .sum();
            let t = stopped.t.expect("a time");
            assert!((t - flat).abs() < 1e-7, "{solver}: {t} {flat}");
            let rows = motion.trajectory.states.len();
            assert_eq!(rows, 1 + (flat / 0.01) as usize, "{solver}");
        }
    }
}

/// Returns two cranks connected by a rod that is as long as the distance of their bearings; the rod is one constraint.
fn cranks_with_a_rod(angle: &str, rate: f64) -> String {
    format!(
        r#"
[model]
name = "cranks"
[parameters]
m = {{ value = 1, unit = "kg" }}
l = {{ value = 1, unit = "m" }}
d = {{ value = 2, unit = "m" }}
[coordinates]
p = {{ unit = "rad", initial = "{angle}", initial_rate = {rate} }}
q = {{ unit = "rad", initial = "{angle}", initial_rate = {rate} }}
[definitions]
rod = "[d + l*cos(q) - l*cos(p), l*sin(q) - l*sin(p)]"
[kinetic]
cranks = "1/2*m*l^2*(dot(p)^2 + dot(q)^2)"
[constraints]
rod = {{ zero = "(dot(rod, rod) - d^2)/d" }}
"#
    )
}

/// At the flat position, rounding errors make the angles differ, so that the constraint keeps its rank and its gradient
/// rotates fast.
#[test]
fn rod_between_cranks_stops_motion_at_its_fold_at_any_tolerance() {
    for rate in [-0.5, 1.0, 3.0, 8.0] {
        let model = compile(&cranks_with_a_rod("1", rate));
        let run = model.with_declared_parameters().expect("an instance");
        let flat = if rate < 0.0 {
            0.0
        } else {
            std::f64::consts::PI
        };
        for (solver, tolerance) in [
            (Solver::Rk, 1e-4),
            (Solver::Rk, 1e-6),
            (Solver::Rk, 1e-9),
            (Solver::Rk, 1e-12),
            (Solver::Radau, 1e-4),
            (Solver::Radau, 1e-9),
        ] {
            let request = Request {
                initial: run.initial_state(),
                times: &[0.0, 1.0, 2.0, 3.0],
                inputs: &run.default_inputs(),
                solver,
                tolerance,
                max_step: f64::INFINITY,
                audit: false,
            };
            let motion = run
                .simulate_until_stop(&request, &mut |_| {})
                .expect("a motion");
            let place = format!("{rate} {solver} {tolerance}");
            let stopped = motion
                .early_stop
                .unwrap_or_else(|| panic!("{place}: passed"));
            assert!(
                stopped
                    .reason
                    .contains("the constraint `rod` has no effect"),
                "{place}: {}",
                stopped.reason
            );
            let t = stopped.t.expect("a time");
            assert!((t - (flat - 1.0) / rate).abs() < 1e-5, "{place}: {t}");
        }
    }
}

#[test]
fn folded_position_has_no_motion_and_no_linearisation() {
    for angle in ["0", "pi", "3.141592653589793", "-pi", "1e-9"] {
        let model = compile(&cranks_with_a_rod(angle, 0.0));
        let run = model.with_declared_parameters().expect("an instance");
        let state = run.initial_state();
        let inputs = run.default_inputs();
        let moved = run.simulate(state, &[0.0, 1.0], &inputs, Solver::Rk);
        let moved = moved.err().unwrap_or_else(|| panic!("{angle}: moves"));
        let point = Point {
            t: 0.0,
            state,
            inputs: &[],
        };
        let linear = run.linearise(point).err();
        let linear = linear.unwrap_or_else(|| panic!("{angle}: linear"));
        for said in [moved.to_string(), linear.to_string()] {
            assert!(
                said.contains("the constraint `rod` has no effect"),
                "{angle}: {said}"
            );
        }
    }
    let model = compile(&cranks_with_a_rod("1e-3", 0.0));
    let run = model.with_declared_parameters().expect("an instance");
    let state = run.initial_state();
    let point = Point {
        t: 0.0,
        state,
        inputs: &[],
    };
    assert!(run.linearise(point).is_ok());
}

/// The speed is so high that a step could skip the flat position. In the second case two linkages are flat at the same
/// time. Parallelogram whose links turn without forces, so that step sizes increase until the linkage is flat.
const FREE_PARALLELOGRAM: &str = r#"
[model]
name = "fold"
[parameters]
J = { value = 0.1, unit = "kg m^2" }
a = { value = 1, unit = "m" }
b = { value = 2, unit = "m" }
[coordinates]
p = { unit = "rad", initial = 1, initial_rate = 2 }
q = { unit = "rad" }
s = { unit = "rad", initial = 1, initial_rate = 2 }
[kinetic]
t = "1/2*J*dot(p)^2 + 1/2*J*dot(s)^2 + 1/2*J*dot(q)^2"
[constraints]
c_1 = { zero = "(a*cos(p) + b*cos(q) - a*cos(s) - b)/a" }
c_2 = { zero = "(a*sin(p) + b*sin(q) - a*sin(s))/a" }
"#;

#[test]
fn steps_end_at_a_fold_for_any_sampling() {
    let fold = 0.5 * (std::f64::consts::PI - 1.0);
    for sample in [0.05, 0.07, 0.08, 0.09, 0.11, 0.14, 0.33, 0.41] {
        for solver in [Solver::Rk, Solver::Radau] {
            let times = grid(3.0, (3.0_f64 / sample).floor() as usize);
            let motion =
                simulate_declared(FREE_PARALLELOGRAM, &times, solver, (1e-9, f64::INFINITY));
            let stopped = motion.early_stop.as_ref().expect("a stop");
            assert!(
                (stopped.t.expect("a time") - fold).abs() < 1e-8,
                "{sample} {solver}: {stopped:?}"
            );
            let evaluations = motion.trajectory.statistics.evaluations;
            assert!(evaluations < 20_000, "{sample} {solver}: {evaluations}");
        }
    }
}

#[test]
fn fold_stops_motion_for_any_sampling_and_solver() {
    let one = parallelogram(0.0).replace("initial = 1.2", "initial_rate = -8, initial = 1.2");
    let mut times = Vec::new();
    for count in [1, 2] {
        let text = match count {
            1 => one.clone(),
            _ => duplicate_linkage(&one),
        };
        let model = compile(&text);
        let run = model.with_declared_parameters().expect("an instance");
        for sample in [0.007, 0.05, 0.07, 0.1, 0.3] {
            for (solver, tolerance) in [
                (Solver::Rk, 1e-4),
                (Solver::Rk, 1e-9),
                (Solver::Radau, 1e-4),
                (Solver::Radau, 1e-8),
            ] {
                let samples = (0..).map(|k| f64::from(k) * sample);
                let request = Request {
                    initial: run.initial_state(),
                    times: &samples.take_while(|t| *t <= 0.601).collect::<Vec<f64>>(),
                    inputs: &run.default_inputs(),
                    solver,
                    tolerance,
                    max_step: f64::INFINITY,
                    audit: false,
                };
                let motion = run
                    .simulate_until_stop(&request, &mut |_| {})
                    .expect("a motion");
                let place = format!("{count} {sample} {solver} {tolerance}");
                let stopped = motion
                    .early_stop
                    .unwrap_or_else(|| panic!("{place}: passed"));
                assert!(
                    stopped.reason.contains("singular position"),
                    "{place}: {}",
                    stopped.reason
                );
                assert!(
                    stopped.reason.contains("`across"),
                    "{place}: {}",
                    stopped.reason
                );
                times.push(stopped.t.expect("a time"));
            }
        }
    }
    for t in &times {
        assert!((t - times[0]).abs() < 1e-4, "{times:?}");
    }
}

/// Slider-crank with crank and rod of equal length. If the slider is at the crank's bearing, crank and rod can rotate
/// about the bearing together.
const SLIDER: &str = r#"
[model]
name = "slider"
[parameters]
m = { value = 1, unit = "kg" }
r = { value = 0.3, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
J = { value = 0.02, unit = "kg m^2" }
w = { value = 20, unit = "rad/s" }
[coordinates]
phi = { unit = "rad", initial = 0.3, initial_rate = 20 }
psi = { unit = "rad", initial = -0.3, initial_rate = -20 }
x = { unit = "m", initial = "2*r*cos(0.3)", initial_rate = "-2*r*w*sin(0.3)" }
[kinetic]
crank = "1/2*J*dot(phi)^2"
rod = "1/2*J*dot(psi)^2"
slider = "1/2*m*dot(x)^2"
[potential]
weight = "m*g*r*sin(phi)"
[constraints]
along = { zero = "r*cos(phi) + r*cos(psi) - x" }
across = { zero = "r*sin(phi) + r*sin(psi)" }
"#;

/// Four-bar linkage (kite) with two adjacent bars of one length and two of another length.
const KITE: &str = r#"
[model]
name = "kite"
[parameters]
J = { value = 0.02, unit = "kg m^2" }
a = { value = 0.2, unit = "m" }
b = { value = 0.5, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
m = { value = 1, unit = "kg" }
[coordinates]
phi = { unit = "rad", initial = 1.2, initial_rate = -3 }
beta = { unit = "rad", initial = 0.2 }
psi = { unit = "rad", initial = 1.2 }
[kinetic]
all = "1/2*m*a^2*dot(phi)^2 + 1/2*J*dot(beta)^2 + 1/2*J*dot(psi)^2"
[potential]
weight = "m*g*a*sin(phi)"
[constraints]
across = { zero = "a*cos(phi) + b*cos(beta) - b - a*cos(psi)" }
up = { zero = "a*sin(phi) + b*sin(beta) - a*sin(psi)" }
"#;

#[test]
fn time_of_fold_is_independent_of_sampling_and_solver() {
    let tilted = parallelogram(0.6);
    for text in [&tilted, SLIDER, KITE] {
        let model = compile(text);
        let run = model.with_declared_parameters().expect("an instance");
        let mut times = Vec::new();
        for sample in [0.01, 0.07] {
            for (solver, tolerance) in [
                (Solver::Rk, 1e-7),
                (Solver::Rk, 1e-11),
                (Solver::Radau, 1e-7),
                (Solver::Radau, 1e-9),
            ] {
                let samples = (0..).map(|k| f64::from(k) * sample);
                let request = Request {
                    initial: run.initial_state(),
                    times: &samples.take_while(|t| *t <= 0.601).collect::<Vec<f64>>(),
                    inputs: &run.default_inputs(),
                    solver,
                    tolerance,
                    max_step: f64::INFINITY,
                    audit: false,
                };
                let motion = run
                    .simulate_until_stop(&request, &mut |_| {})
                    .expect("a motion");
                let stopped = motion.early_stop.expect("a stop");
                let reason = &stopped.reason;
                assert!(reason.contains("singular position"), "{reason}");
                times.push(stopped.t.expect("a time"));
            }
        }
        for t in &times {
            assert!((t - times[0]).abs() < 1e-7, "{times:?} of {text}");
        }
    }
}

fn duplicate_linkage(text: &str) -> String {
    let mut copied = String::new();
    for line in text.lines() {
        copied.push_str(line);
        copied.push('\n');
        let names = [
            "phi", "psi", "beta", "cranks", "coupler", "weight", "across", "up",
        ];
        let Some((name, _)) = line.split_once(" = ") else {
            continue;
        };
        if names.contains(&name) {
            let mut copy = line.to_owned();
            for name in names {
                copy = copy.replace(name, &format!("{name}_2"));
            }
            copied.push_str(&copy);
            copied.push('\n');
        }
    }
    copied
}

/// The constraints of a platform on two rods and of a rotating rod never lose rank.
#[test]
fn rotating_rod_is_not_stopped() {
    let model = compile_changed(
        "y = { unit = \"m\" }",
        "y = { unit = \"m\", initial_rate = 12 }",
    );
    let run = model.with_declared_parameters().unwrap();
    for tolerance in [1e-3, 1e-9] {
        for solver in [Solver::Rk, Solver::Radau] {
            let request = Request {
                initial: run.initial_state(),
                times: &[0.0, 3.0],
                inputs: &run.default_inputs(),
                solver,
                tolerance,
                max_step: f64::INFINITY,
                audit: false,
            };
            let motion = run.simulate_until_stop(&request, &mut |_| {}).unwrap();
            assert!(
                motion.early_stop.is_none(),
                "{solver} {tolerance}: {:?}",
                motion.early_stop
            );
        }
    }
}

#[test]
fn constraint_residual_decays_at_given_rate() {
    let model = compile(ROD);
    let run = model
        .with_parameters(&[("stabilisation_rate", 20.0)])
        .unwrap();
    let evaluator = RefCell::new(run.evaluator().unwrap());
    let inputs = run.default_inputs();
    let system = DrivenModel::new(&evaluator, &inputs);
    let start = [0.72, 0.0, 0.1, 0.0];
    let residual = |state: &[f64]| state[0].powi(2) + state[1].powi(2) - 0.49;
    let rate = |state: &[f64]| 2.0 * (state[0] * state[2] + state[1] * state[3]);
    let times = [0.0, 0.1, 0.3];
    let settings = Settings::with_tolerance(1e-11);
    let found = simulate(&system, &start, (0.0, 0.3), &times, &settings, &mut |_| {}).unwrap();
    for (t, state) in times.iter().zip(&found.states) {
        // Solution of g'' + 2 w g' + w^2 g = 0.
        let (g, g_dot) = (residual(&start), rate(&start));
        let expected = (g + (g_dot + 20.0 * g) * t) * (-20.0 * t).exp();
        assert!(
            (residual(state) - expected).abs() < 1e-9,
            "at {t}: {}",
            residual(state)
        );
    }
}

#[test]
fn equilibrium_satisfies_constraints() {
    let model = compile_changed("initial = \"l\"", "initial = 0.3");
    let run = model.with_declared_parameters().unwrap();
    let found = run.find_equilibrium(EquilibriumRequest::default()).unwrap();
    let [x, y, ..] = found.point.state[..] else {
        panic!("{found:?}")
    };
    assert!(x.abs() < 1e-9 && (y.abs() - 0.7).abs() < 1e-9, "{x}, {y}");
}

#[test]
fn rolling_disc_conserves_energy_and_sleigh_straightens() {
    let model = compile_feature("rolling_disc", Orders::Declared);
    let run = model.with_declared_parameters().unwrap();
    let times: Vec<f64> = (0..=50).map(f64::from).collect();
    let motion = run
        .simulate(
            run.initial_state(),
            &times,
            &run.default_inputs(),
            Solver::Auto,
        )
        .unwrap();
    let observables = run.observables(&motion).unwrap();
    let energies: Vec<f64> = observables.iter().map(|row| row[row.len() - 2]).collect();
    for energy in &energies {
        assert!(
            (energy / energies[0] - 1.0).abs() < 1e-6,
            "{energy} of {}",
            energies[0]
        );
    }
    let sleigh = compile(eomgen_model_spec::models::CHAPLYGIN_SLEIGH.text);
    let run = sleigh.with_declared_parameters().unwrap();
    let motion = run
        .simulate(
            run.initial_state(),
            &[0.0, 60.0],
            &run.default_inputs(),
            Solver::Auto,
        )
        .unwrap();
    let (first, last) = (&motion.trajectory.states[0], &motion.trajectory.states[1]);
    // At the end, the sleigh moves along the edge and all energy is kinetic: m v^2 = m (x'^2 + y'^2) + J theta'^2.
    let energy = 2.0 * (first[3].powi(2) + first[4].powi(2)) + 0.12 * first[5].powi(2);
    assert!(last[5].abs() < 1e-9, "{}", last[5]);
    assert!((last[3].hypot(last[4]) - (energy / 2.0).sqrt()).abs() < 1e-7);
}

/// With constraints at the end of a field, each additional mode must need only a few operations (with its shape at the
/// end), as with a tip mass.
#[test]
fn constraints_add_few_operations_per_mode() {
    let per_mode = |constrained: bool| {
        let operations = |order: usize| {
            let mut text = feature_text("flexible_coupler");
            if !constrained {
                let (start, end) = (
                    text.find("[constraints]").unwrap(),
                    text.find("[observables]").unwrap(),
                );
                text.truncate(end.min(start));
            }
            let model =
                CompiledModel::from_text("coupler.toml", &text, Orders::Uniform(order)).unwrap();
            let program = model.program();
            program.operations(&program.accelerations.all())
        };
        (operations(64) - operations(32)) as f64 / 32.0
    };
    let (with, without) = (per_mode(true), per_mode(false));
    println!("{with} and {without} operations for a mode");
    assert!(with <= without + 4.0, "{with} and {without}");
}

fn feature_text(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/constrained");
    std::fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap()
}

/// The multipliers of the emitted equations are the joint forces; the rocker's equation of motion must be satisfied
/// with them.
#[test]
fn multipliers_equal_joint_forces() {
    let model = compile_feature("flexible_coupler", Orders::Declared);
    let run = model.with_declared_parameters().unwrap();
    let inputs = run.default_inputs();
    let (state, _) = run
        .find_consistent_state(run.initial_state(), 0.0, &inputs)
        .unwrap();
    let mut evaluator = run.evaluator().unwrap();
    let mut observables = vec![0.0; evaluator.program().observables.len()];
    let inputs = &inputs.evaluate(0.0);
    let point = Point {
        t: 0.0,
        state: &state,
        inputs,
    };
    evaluator.observables(point, &mut observables);
    let names = model.observable_names();
    let seen = |name: &str| observables[names.iter().position(|known| known == name).unwrap()];
    let mut rates = vec![0.0; state.len()];
    evaluator.rates(point, &mut rates);
    // Equation of the rocker: J_3 gamma'' = l_3 (lambda_across sin(gamma) - lambda_along
    // cos(gamma)).
    let gamma = state[2];
    let torque = 0.24 * (seen("lambda_across") * gamma.sin() - seen("lambda_along") * gamma.cos());
    let degrees = state.len() / 2;
    assert!((2e-3 * rates[degrees + 2] - torque).abs() < 1e-10 * torque.abs());
    assert!(seen("pull") > 0.0);
}

#[test]
fn constraint_nonlinear_in_rates_is_rejected_with_location() {
    let text = ROD.replace("x^2 + y^2 - l^2", "dot(x)^2 - dot(y)^2");
    let found = CompiledModel::from_text("rod.toml", &text, Orders::Declared);
    let message = found
        .err()
        .map(|error| error.to_string())
        .unwrap_or_default();
    assert!(message.contains("not linear in the rates"), "{message}");
}

/// Source: Meijaard, Papadopoulos, Ruina and Schwab 2007, Table 2: eigenvalues of weave, capsize and castering at
/// several speeds.
#[test]
fn bicycle_has_published_eigenvalues() {
    let model = compile_feature("bicycle", Orders::Declared);
    let published: [(f64, [(f64, f64); 3]); 2] = [
        (
            5.0,
            [
                (-0.775_341_882_195_85, 4.464_867_713_788_23),
                (-0.322_866_429_004_09, 0.0),
                (-14.078_389_692_798_22, 0.0),
            ],
        ),
        (
            0.0,
            [
                (3.131_643_247_906_56, 0.0),
                (5.530_943_717_653_93, 0.0),
                (-3.131_643_247_906_56, 0.0),
            ],
        ),
    ];
    for (speed, expected) in published {
        let run = model.with_parameters(&[("v", speed)]).unwrap();
        let (state, moved) = run
            .find_consistent_state(run.initial_state(), 0.0, &run.default_inputs())
            .unwrap();
        assert!(moved.is_empty(), "{moved:?}");
        let point = Point {
            t: 0.0,
            state: &state,
            inputs: &[],
        };
        let linear = run.linearise(point).unwrap();
        let degrees = state.len() / 2;
        let modes = constrained_modes(
            &linear.a,
            &linear.constraint_matrix(&model),
            degrees,
            model.typical_sizes(),
        )
        .unwrap();
        for (re, im) in expected {
            let near = modes
                .iter()
                .map(|mode| (mode.eigenvalue.re - re).hypot(mode.eigenvalue.im - im));
            let near = near.fold(f64::INFINITY, f64::min);
            let all: Vec<_> = modes.iter().map(|mode| mode.eigenvalue).collect();
            assert!(near < 1e-9, "{speed} m/s, {re} {im}: {near:e} of {all:?}");
        }
    }
}

/// Returns a planar chain of point masses on rods, in Cartesian coordinates with constraints and in
/// angles.
fn chain(lengths: &[f64], masses: &[f64]) -> [String; 2] {
    let count = lengths.len();
    let parameters = (0..count).map(|i| {
        let (l, m) = (lengths[i], masses[i]);
        format!(
            "l_{i} = {{ value = {l}, unit = \"m\" }}\nm_{i} = {{ value = {m}, unit = \"kg\" }}\n"
        )
    });
    let head = format!(
        "[model]\nname = \"chain\"\n\n[parameters]\ng = {{ value = 9.81, unit = \"m/s^2\" }}\n{}\n",
        parameters.collect::<String>()
    );
    let each = |line: &dyn Fn(usize) -> String| (0..count).map(line).collect::<String>();
    let energies = format!(
        "[kinetic]\n{}\n[potential]\n{}\n",
        each(&|i| format!("m_{i} = \"1/2*m_{i}*(dot(x_{i})^2 + dot(y_{i})^2)\"\n")),
        each(&|i| format!("m_{i} = \"m_{i}*g*y_{i}\"\n")),
    );
    let coordinates =
        each(&|i| format!("x_{i} = {{ unit = \"m\" }}\ny_{i} = {{ unit = \"m\" }}\n"));
    let before = |i: usize, of: &str| match i {
        0 => String::new(),
        _ => format!(" - {of}_{}", i - 1),
    };
    let rods = each(&|i| {
        let (x, y) = (before(i, "x"), before(i, "y"));
        format!("rod_{i} = {{ zero = \"(x_{i}{x})^2 + (y_{i}{y})^2 - l_{i}^2\" }}\n")
    });
    let places = format!("{head}[coordinates]\n{coordinates}\n{energies}[constraints]\n{rods}");
    let angles = each(&|i| format!("a_{i} = {{ unit = \"rad\" }}\n"));
    let plus = |i: usize, of: &str| match i {
        0 => String::new(),
        _ => format!("{of}_{} + ", i - 1),
    };
    let definitions = each(&|i| {
        let (x, y) = (plus(i, "x"), plus(i, "y"));
        format!("x_{i} = \"{x}l_{i}*cos(a_{i})\"\ny_{i} = \"{y}l_{i}*sin(a_{i})\"\n")
    });
    let angles = format!("{head}[coordinates]\n{angles}\n[definitions]\n{definitions}\n{energies}");
    [places, angles]
}

/// Accelerations of random chains at random states are compared in Cartesian coordinates and in angles.
#[test]
fn random_chains_match_in_cartesian_coordinates_and_angles() {
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    for count in [1, 2, 3, 5, 8] {
        let mut some = |low: f64, high: f64| -> Vec<f64> {
            (0..count).map(|_| low + (high - low) * random()).collect()
        };
        let (lengths, masses) = (some(0.2, 2.0), some(0.1, 5.0));
        let (angles, turns) = (some(-3.0, 3.0), some(-4.0, 4.0));
        let [places, in_angles] = chain(&lengths, &masses);
        let rates = |text: &str, state: &[f64]| {
            let model = compile(text);
            let mut evaluator = model
                .with_declared_parameters()
                .unwrap()
                .evaluator()
                .unwrap();
            let mut rates = vec![0.0; state.len()];
            let point = Point {
                t: 0.0,
                state,
                inputs: &[],
            };
            evaluator.rates(point, &mut rates);
            rates
        };
        let turned = rates(&in_angles, &[&angles[..], &turns].concat());
        let (mut at, mut speed, mut expected) = (Vec::new(), Vec::new(), Vec::new());
        let mut sums = [[0.0; 2]; 3];
        for i in 0..count {
            let (sine, cosine) = angles[i].sin_cos();
            let (l, w, a) = (lengths[i], turns[i], turned[count + i]);
            let own = [
                [l * cosine, l * sine],
                [-l * w * sine, l * w * cosine],
                [
                    -l * (a * sine + w * w * cosine),
                    l * (a * cosine - w * w * sine),
                ],
            ];
            for (sum, own) in sums.iter_mut().flatten().zip(own.as_flattened()) {
                *sum += own;
            }
            at.extend(sums[0]);
            speed.extend(sums[1]);
            expected.extend(sums[2]);
        }
        let found = rates(&places, &[at, speed].concat());
        let largest = expected.iter().fold(1.0_f64, |most, a| most.max(a.abs()));
        for (found, expected) in found[2 * count..].iter().zip(&expected) {
            let error = (found - expected).abs() / largest;
            assert!(error < 1e-10, "{count} masses: {found} and {expected}");
        }
    }
}

/// Returns a crank that drives a sliding mass with dry friction. The coordinate is the angle of the crank; if
/// `is_constrained`, the position of the mass is a second coordinate. `position` is the position as a function of the
/// angle, `transmission` its derivative at the start.
fn crank_with_dry_friction(
    (position, transmission): (&str, f64),
    rate: f64,
    is_constrained: bool,
) -> CompiledModel {
    let [coordinate, definition, constraint] = match is_constrained {
        true => [
            format!(
                "s = {{ unit = \"m\", initial = \"{}\", initial_rate = {:?} }}\n",
                position.replace("phi", "p0"),
                transmission * rate
            ),
            String::new(),
            format!("[constraints]\nrod = {{ zero = \"s - ({position})\" }}\n"),
        ],
        false => [
            String::new(),
            format!("[definitions]\ns = \"{position}\"\n"),
            String::new(),
        ],
    };
    compile(&format!(
        r#"
[model]
name = "crank"
[parameters]
J = {{ value = 0.002, unit = "kg m^2" }}
r = {{ value = 0.04, unit = "m" }}
l = {{ value = 0.14, unit = "m" }}
m = {{ value = 0.5, unit = "kg" }}
F = {{ value = 3, unit = "N" }}
p0 = {{ value = 2, unit = "rad" }}
[coordinates]
phi = {{ unit = "rad", initial = "p0", initial_rate = {rate:?} }}
{coordinate}{definition}[kinetic]
crank = "1/2*J*dot(phi)^2"
mass = "1/2*m*dot(s)^2"
[forces]
friction = {{ on = "s", value = "-F*sign(dot(s))" }}
{constraint}"#
    ))
}

/// At a dead centre the friction has no lever arm, so the crank passes it. Then the friction stops the machine.
#[test]
fn dry_friction_stops_constrained_crank_like_unconstrained_crank() {
    let (sine, cosine) = 2.0_f64.sin_cos();
    let rod = (0.14_f64.powi(2) - (0.04 * sine).powi(2)).sqrt();
    let guide = ("r*sin(phi)", 0.04 * cosine);
    let with_rod = (
        "r*cos(phi) + sqrt(l^2 - r^2*sin(phi)^2)",
        -0.04 * sine - 0.04_f64.powi(2) * sine * cosine / rod,
    );
    let times: Vec<f64> = (0..=20).map(|sample| 0.05 * f64::from(sample)).collect();
    for machine in [guide, with_rod] {
        for rate in [11.0, 11.2, 12.0, 12.8, 13.1, 14.3] {
            let simulate = |is_constrained: bool, solver| {
                let model = crank_with_dry_friction(machine, rate, is_constrained);
                let run = model.with_declared_parameters().unwrap();
                run.simulate(run.initial_state(), &times, &run.default_inputs(), solver)
                    .unwrap_or_else(|error| panic!("{machine:?} {rate} {solver}: {error}"))
            };
            let expected = simulate(false, Solver::Rk);
            let expected_log = expected.event_log(1);
            assert_eq!(
                expected_log.last().map(|event| event.kind),
                Some(EventKind::Stick)
            );
            for solver in [Solver::Rk, Solver::Radau] {
                let motion = simulate(true, solver);
                let (log, subject) = (motion.event_log(2), format!("{machine:?} {rate} {solver}"));
                assert_eq!(log.len(), expected_log.len(), "{subject}: {log:?}");
                for (event, expected) in log.iter().zip(&expected_log) {
                    assert_eq!(event.kind, expected.kind, "{subject}");
                    assert!((event.t - expected.t).abs() < 1e-6, "{subject}: {event:?}");
                }
                let [state, expected] =
                    [&motion, &expected].map(|motion| &motion.trajectory.final_state);
                assert!(
                    (state[0] - expected[0]).abs() < 1e-6,
                    "{subject}: {state:?}"
                );
                assert!(
                    state[2].abs() < 1e-9 && state[3].abs() < 1e-9,
                    "{subject}: {state:?}"
                );
            }
        }
    }
}
