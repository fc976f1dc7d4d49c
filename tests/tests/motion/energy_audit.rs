//! Tests of the energy audit of `simulate`: only unexplained energy gives a warning.

use eomgen_compiled_model::{Audit, CompiledModel, Orders, Request, Solver};
use eomgen_tests::models::{load, shipped_specifications};
use eomgen_tests::program::{run, text};
use serde_json::Value;

/// Bead on a wire with a corner; the inertia jumps at x = 0.
const CORNER: &str = r#"
[model]
name = "corner"
[parameters]
m = { value = 1, unit = "kg" }
a = { value = 1, unit = "1" }
[coordinates]
x = { unit = "m", initial = -1, initial_rate = 1 }
[definitions]
y = "a*max(x, 0)"
[kinetic]
t = "1/2*m*(dot(x)^2 + dot(y)^2)"
"#;

/// Mass at a potential step that is higher than the kinetic energy.
const STEP: &str = r#"
[model]
name = "step"
[parameters]
m = { value = 1, unit = "kg" }
U = { value = 1, unit = "J" }
[coordinates]
x = { unit = "m", initial = -1, initial_rate = 1 }
[kinetic]
t = "1/2*m*dot(x)^2"
[potential]
v = "U*above(x)"
"#;

/// Mass on a spring whose base suddenly starts to move at a finite speed.
const BASE: &str = r#"
[model]
name = "base"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 40, unit = "N/m" }
v = { value = 0.5, unit = "m/s" }
t_0 = { value = 1, unit = "s" }
[coordinates]
x = { unit = "m" }
[definitions]
place = "v*max(t - t_0, 0) + x"
[kinetic]
mass = "1/2*m*dot(place)^2"
[potential]
spring = "1/2*k*x^2"
"#;

/// Mass on a spring with prescribed motion of the base. Both are initially at rest.
const PRESCRIBED_BASE: &str = r#"
[model]
name = "prescribed_base"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 8, unit = "N/m" }
[coordinates]
x = { unit = "m" }
[inputs]
s = { unit = "m", rates = 2 }
[kinetic]
mass = "1/2*m*(dot(x) + dot(s))^2"
[potential]
spring = "1/2*k*x^2"
"#;

/// Ball on a table at rest or on a shaking table.
const BALL: &str = r#"
[model]
name = "ball"
[parameters]
m = { value = 0.2, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
A = { value = 0, unit = "m" }
w = { value = 20, unit = "rad/s" }
[coordinates]
y = { unit = "m", initial = 0.5 }
[kinetic]
ball = "1/2*m*dot(y)^2"
[potential]
weight = "m*g*y"
[impacts]
table = { when = "y", restitution = 0.7 }
"#;

fn audit_of_text(text: &str, until: f64, solver: Solver, tolerance: f64) -> Audit {
    let model = CompiledModel::from_text("model.toml", text, Orders::Declared).expect("a model");
    audit(&model, until, solver, tolerance)
}

fn audit(model: &CompiledModel, until: f64, solver: Solver, tolerance: f64) -> Audit {
    let run = model.with_declared_parameters().expect("values");
    let times = [0.0, 0.5 * until, until];
    let request = Request {
        initial: run.initial_state(),
        times: &times,
        inputs: &run.default_inputs(),
        solver,
        tolerance,
        max_step: f64::INFINITY,
        audit: true,
    };
    let motion = run
        .simulate_until_stop(&request, &mut |_| {})
        .expect("a motion");
    motion.audit.expect("an audit")
}

#[test]
fn shipped_models_gain_no_energy_at_any_tolerance() {
    for path in shipped_specifications() {
        let name = path.file_stem().expect("a name").to_string_lossy();
        let model = CompiledModel::derive(load(&name), Orders::Declared).expect("a model");
        let limits = [1e-9, 1e-6, 1e-3, 1e-2].map(|tolerance| (Solver::Rk, tolerance));
        let all = [
            (Solver::Auto, 1e-9),
            (Solver::Radau, 1e-6),
            (Solver::Radau, 1e-3),
        ];
        for (solver, tolerance) in all.into_iter().chain(limits) {
            let audit = audit(&model, 0.3, solver, tolerance);
            assert_eq!(
                audit.fault_count, 0,
                "{name}, {solver}, {tolerance}: {audit:?}"
            );
            assert_eq!(audit.exclusion_reason, None, "{name}");
        }
    }
}

#[test]
fn energy_is_conserved_or_a_warning_is_given() {
    for (name, text) in [("corner", CORNER), ("step", STEP), ("base", BASE)] {
        for solver in [Solver::Auto, Solver::Rk, Solver::Radau] {
            let audit = audit_of_text(text, 3.0, solver, 1e-9);
            let is_kept = audit.unexplained_energy().abs() < 1e-6;
            assert_eq!(
                audit.fault_count == 0,
                is_kept,
                "{name}, {solver}: {audit:?}"
            );
            let warning = audit.warning_message();
            assert_eq!(warning.is_none(), is_kept, "{warning:?}");
        }
    }
}

#[test]
fn energy_error_of_loose_tolerances_gives_a_warning() {
    for (k, amplitude) in [(400.0, 0.15), (4.0, 2.0), (4e6, 1e-3)] {
        let text = format!(
            r#"
[model]
name = "hardening"
[parameters]
m = {{ value = 1, unit = "kg" }}
k = {{ value = {k}, unit = "N/m" }}
a = {{ value = {amplitude}, unit = "m" }}
[coordinates]
x = {{ unit = "m", initial = "a" }}
[kinetic]
t = "1/2*m*dot(x)^2"
[potential]
v = "1/2*k*x^2 + 1/4*k*x^4/a^2"
"#
        );
        let energy = 0.75 * k * amplitude * amplitude;
        let until = 300.0 / f64::sqrt(k);
        for solver in [Solver::Rk, Solver::Radau, Solver::Adams] {
            let [loose, tight] =
                [3e-2, 1e-7].map(|tolerance| audit_of_text(&text, until, solver, tolerance));
            assert!(loose.unexplained_energy().abs() > 0.1 * energy, "{loose:?}");
            assert!(loose.has_failed(), "{solver}, {k} N/m: {loose:?}");
            assert!(loose.warning_message().is_some());
            assert!(
                tight.unexplained_energy().abs() < 1e-2 * energy,
                "{tight:?}"
            );
            assert!(!tight.has_failed(), "{solver}, {k} N/m: {tight:?}");
        }
    }
}

#[test]
fn losses_at_impacts_are_accounted_for() {
    for solver in [Solver::Rk, Solver::Radau] {
        let audit = audit_of_text(BALL, 5.0, solver, 1e-9);
        assert_eq!(audit.fault_count, 0, "{audit:?}");
        // The final state is at rest, so m g y = 0.981 J is lost.
        assert!((audit.impact_energy + 0.981).abs() < 1e-6, "{audit:?}");
        assert!(audit.unexplained_energy().abs() < 1e-6, "{audit:?}");
    }
}

#[test]
fn work_of_shaking_table_is_accounted_for() {
    let text = BALL
        .replace("when = \"y\"", "when = \"y - A*sin(w*t)\"")
        .replace("A = { value = 0,", "A = { value = 0.01,");
    for (text, solver) in [
        &text,
        &text.replace("initial = 0.5", "initial = 0, initial_rate = 0.2"),
    ]
    .into_iter()
    .flat_map(|text| [(text, Solver::Rk), (text, Solver::Radau)])
    {
        let audit = audit_of_text(text, 2.0, solver, 1e-9);
        assert_eq!(audit.fault_count, 0, "{audit:?}");
        assert_eq!(audit.exclusion_reason, None);
        assert!(audit.impact_energy <= 0.0 && audit.work != 0.0, "{audit:?}");
        assert!(audit.unexplained_energy().abs() < 1e-6, "{audit:?}");
    }
}

#[test]
fn work_of_moving_wall_equals_work_of_its_impulse() {
    // The moving wall hits the ball at rest with speed V; the ball leaves with (1 + e) V.
    let text = BALL
        .replace("weight = \"m*g*y\"", "weight = \"0*m*g*y\"")
        .replace("when = \"y\"", "when = \"y - A*w*t\"")
        .replace("A = { value = 0,", "A = { value = 0.05,");
    for solver in [Solver::Rk, Solver::Radau] {
        let audit = audit_of_text(&text, 2.0, solver, 1e-9);
        let (energy, work) = (0.5 * 0.2 * 1.7_f64.powi(2), 0.2 * 1.7);
        assert_eq!(audit.fault_count, 0, "{audit:?}");
        assert!((audit.energy_change - energy).abs() < 1e-9, "{audit:?}");
        assert!((audit.work - work).abs() < 1e-9, "{audit:?}");
        assert!(
            (audit.impact_energy - (energy - work)).abs() < 1e-9,
            "{audit:?}"
        );
    }
}

#[test]
fn lift_does_work_on_its_load() {
    let text = BALL
        .replace("initial = 0.5", "initial = 0, initial_rate = 1")
        .replace("when = \"y\"", "when = \"y - A*w*t\"")
        .replace("A = { value = 0,", "A = { value = 0.05,");
    for solver in [Solver::Rk, Solver::Radau] {
        let audit = audit_of_text(&text, 2.0, solver, 1e-9);
        assert_eq!(audit.fault_count, 0, "{audit:?}");
        assert!((audit.work - 0.2 * 9.81 * 2.0).abs() < 1e-9, "{audit:?}");
        assert!(audit.impact_energy.abs() < 1e-9, "{audit:?}");
    }
}

#[test]
fn audit_omits_contacts_moved_by_inputs() {
    let text = BALL.replace("when = \"y\"", "when = \"y - s\"").replace(
        "[kinetic]",
        "[inputs]\ns = { unit = \"m\", rates = 2 }\n[kinetic]",
    );
    let audit = audit_of_text(&text, 2.0, Solver::Rk, 1e-9);
    assert_eq!(audit.fault_count, 0, "{audit:?}");
    let reason = audit.exclusion_reason.expect("a reason");
    assert!(reason.contains("`table`"), "{reason}");
}

/// Mass that is at rest until a force starts.
const PUSHED: &str = r#"
[model]
name = "pushed"
[parameters]
m = { value = 1, unit = "kg" }
F = { value = 30, unit = "N" }
a = { value = 3, unit = "s" }
c = { value = 1, unit = "N s^2/m^2" }
[coordinates]
x = { unit = "m" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[forces]
push = { on = "x", value = "F*above(t - a)" }
damper = { on = "x", value = "-c*dot(x)*abs(dot(x))" }
"#;

#[test]
fn switched_force_gives_no_warning() {
    for (force, begin) in [
        ("30", "3"),
        ("1000", "3"),
        ("30", "0.7"),
        ("3e6", "300"),
        ("1e-6", "7.3"),
    ] {
        let text = PUSHED
            .replace("value = 30,", &format!("value = {force},"))
            .replace("value = 3,", &format!("value = {begin},"));
        let until = 2.0 * begin.parse::<f64>().expect("a number");
        for tolerance in [1e-9, 1e-5] {
            for solver in [Solver::Rk, Solver::Radau] {
                let audit = audit_of_text(&text, until, solver, tolerance);
                assert_eq!(
                    audit.fault_count, 0,
                    "{force} {begin} {solver} {tolerance}: {audit:?}"
                );
            }
        }
    }
}

#[test]
fn audit_does_not_change_the_motion() {
    for text in [CORNER, BASE, BALL] {
        let model =
            CompiledModel::from_text("model.toml", text, Orders::Declared).expect("a model");
        let run = model.with_declared_parameters().expect("values");
        let times: Vec<f64> = (0..=50).map(|row| 0.06 * f64::from(row)).collect();
        for solver in [Solver::Rk, Solver::Radau] {
            let [with, without] = [true, false].map(|audit| {
                let request = Request {
                    initial: run.initial_state(),
                    times: &times,
                    inputs: &run.default_inputs(),
                    solver,
                    tolerance: 1e-9,
                    max_step: f64::INFINITY,
                    audit,
                };
                run.simulate_until_stop(&request, &mut |_| {})
                    .expect("a motion")
                    .trajectory
            });
            assert_eq!(with.states, without.states);
            assert_eq!(with.events, without.events);
        }
    }
}

#[test]
fn strict_simulation_exits_with_1_on_unexplained_energy() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("base.toml");
    std::fs::write(&spec, BASE).expect("writable");
    let out = folder.path().join("motion.csv").display().to_string();
    let spec = spec.display().to_string();
    let simulate = ["simulate", &spec, "--until", "3", "--out", &out];
    let output = run(&[&simulate[..], &["--json"]].concat());
    let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let audit = &document["energy_audit"];
    let has_faults = audit["faults"].as_u64().expect("a count") > 0;
    assert_eq!(output.status.code(), Some(0));
    let warned = text(&output.stderr).contains("J without work at t = ");
    assert_eq!(warned, has_faults);
    let strict = run(&[&simulate[..], &["--strict"]].concat());
    assert_eq!(strict.status.code(), Some(i32::from(has_faults)));
    let unexplained = audit["residual"].as_f64().expect("a number");
    assert_eq!(unexplained.abs() > 1e-6, has_faults, "{audit}");
}

#[test]
fn base_that_starts_from_rest_has_no_unexplained_energy() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("base.toml").display().to_string();
    std::fs::write(&spec, PRESCRIBED_BASE).expect("writable");
    let out = folder.path().join("motion.csv").display().to_string();
    let motions = [
        "s=3/2*max(t - 1, 0)^2",
        "s=1e-3*max(t - 1, 0)^2",
        "s=above(t - 1)*(1 - cos(2*(t - 1)))",
        "s=max(t - 0.5, 0)^2*sin(t)",
        "s=above(t - 1)*(t - 1)",
    ];
    for motion in motions {
        for solver in ["rk", "radau"] {
            for start in ["x=0", "x=1e-9"] {
                let case = format!("{motion} {solver} {start}");
                let options = ["--input", motion, "--solver", solver, "--state", start];
                let simulate = ["simulate", &spec, "--until", "2", "--out", &out, "--strict"];
                let output = run(&[&simulate[..], &options].concat());
                assert_eq!(
                    output.status.code(),
                    Some(0),
                    "{case}: {}",
                    text(&output.stderr)
                );
            }
        }
    }
    // m (x'' + 3) + k x = 0 from t = 1 s on.
    let options = ["--input", motions[0], "--interval", "1"];
    run(&[
        &["simulate", &spec, "--until", "2", "--out", &out][..],
        &options,
    ]
    .concat());
    let rows = std::fs::read_to_string(&out).expect("rows");
    let mut last = rows.lines().last().expect("a row").split(',');
    let x: f64 = last.nth(1).and_then(|x| x.parse().ok()).expect("a number");
    assert!((x - 0.75 * (2.0_f64.cos() - 1.0)).abs() < 1e-8, "{x}");
}

/// Mass that a short pulse of an input can push within 100 s.
const PULSE: &str = r#"
[model]
name = "pulse"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 1, unit = "N/m^3" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/4*k*x^4"
[forces]
push = { on = "x", value = "u" }
"#;

#[test]
fn max_step_detects_short_pulse() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("pulse.toml");
    std::fs::write(&spec, PULSE).expect("writable");
    let out = folder.path().join("motion.csv");
    let (spec, file) = (spec.display().to_string(), out.display().to_string());
    let pulse = "u=100*exp(-((t - 63.4)/0.005)^2)";
    let simulate = [
        "simulate",
        &spec,
        "--until",
        "100",
        "--interval",
        "20",
        "--out",
        &file,
    ];
    let options = ["--solver", "rk", "--input", pulse, "--max-step", "0.01"];
    let output = run(&[&simulate[..], &options].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let table = std::fs::read_to_string(&out).expect("a table");
    let energy = table
        .lines()
        .last()
        .expect("a row")
        .split(',')
        .nth(3)
        .expect("energy");
    // The pulse with an amplitude of 100 N and an effective duration of 5 ms sqrt(pi) gives a momentum of 0.886 N s.
    let energy: f64 = energy.parse().expect("a number");
    let momentum = 100.0 * 0.005 * std::f64::consts::PI.sqrt();
    assert!(
        (energy - 0.5 * momentum * momentum).abs() < 1e-6,
        "{energy}"
    );
    for wrong in ["0", "-1", "nan", "1e-30"] {
        let options = ["--solver", "rk", "--input", pulse, "--max-step", wrong];
        let output = run(&[&simulate[..], &options].concat());
        assert_eq!(output.status.code(), Some(2), "{wrong}");
        assert!(
            text(&output.stderr).contains("longest step"),
            "{}",
            text(&output.stderr)
        );
    }
}

/// Machines with contacts, in coordinates of the inertial frame; `{x}` stands for a coordinate or a definition.
const CONTACTS: [&str; 4] = [
    // Ball with friction on an oscillating floor.
    r#"
[kinetic]
ball = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[impacts]
floor = { when = "y - 0.02*L*sin(9*h*t)", restitution = 0.6, friction = 0.2, slip = "dot(x) - 0.5*L*h" }
"#,
    // Ball on a rope that becomes taut and remains taut.
    r#"
[kinetic]
ball = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[impacts]
rope = { when = "1.2*L - sqrt((x - L)^2 + y^2)", restitution = 0 }
"#,
    // Ball on a guide that moves, between a floor and the guide.
    r#"
[kinetic]
ball = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[constraints]
guide = { zero = "0.6*x + 0.8*y - 1.04*L - 0.1*L*sin(5*h*t)" }
[impacts]
floor = { when = "y", restitution = 0.5 }
"#,
    // Two bodies that hit each other and a wall, with a damper.
    r#"
[kinetic]
bodies = "1/2*m*dot(x)^2 + m*dot(y)^2"
[potential]
spring = "1/2*m*h^2*(9*x^2 + 4*y^2)"
[forces]
damper = { on = "y", value = "-0.2*m*h*dot(y)" }
[impacts]
bodies = { when = "x - y + 0.3*L", restitution = 0.7 }
wall = { when = "1.3*L - x", restitution = 0 }
"#,
];

/// Moving frames: position (x, y) as a function of the coordinates (a, b), and initial values of the coordinates. All
/// start at x = 1 m, y = 0.55 m with the rates 0.5 m/s and -1 m/s.
const FRAMES: [(&str, [&str; 4]); 4] = [
    (r#"x = "a""#, ["1", "0.5", "0.55", "-1"]),
    // Uniform motion.
    (
        "x = \"a + 2*L*h*t\"\ny = \"b - 3*L*h*t\"",
        ["1", "-1.5", "0.55", "2"],
    ),
    // Rotation.
    (
        "x = \"a*cos(2*h*t) - b*sin(2*h*t)\"\ny = \"a*sin(2*h*t) + b*cos(2*h*t)\"",
        ["1", "1.6", "0.55", "-3"],
    ),
    // Acceleration and oscillation.
    (
        "x = \"a + L*(h*t)^2\"\ny = \"b + 0.3*L*sin(4*h*t)\"",
        ["1", "0.5", "0.55", "-2.2"],
    ),
];

/// Returns a machine of [`CONTACTS`] in a frame.
fn contacts_in_frame(machine: &str, (frame, [a, a_rate, b, b_rate]): (&str, [&str; 4])) -> String {
    let frame = match frame.contains("y = ") {
        true => frame.to_owned(),
        false => format!("{frame}\ny = \"b\""),
    };
    format!(
        r#"
[model]
name = "frame"
[parameters]
m = {{ value = 0.4, unit = "kg" }}
g = {{ value = 9.81, unit = "m/s^2" }}
L = {{ value = 1, unit = "m" }}
h = {{ value = 1, unit = "1/s" }}
[coordinates]
a = {{ unit = "m", initial = {a}, initial_rate = {a_rate} }}
b = {{ unit = "m", initial = {b}, initial_rate = {b_rate} }}
[definitions]
{frame}
{machine}"#
    )
}

#[test]
fn losses_at_contacts_do_not_depend_on_the_frame() {
    for machine in CONTACTS {
        for solver in [Solver::Rk, Solver::Radau] {
            let [own, moving @ ..] = FRAMES.map(|frame| {
                let text = contacts_in_frame(machine, frame);
                let audit = audit_of_text(&text, 1.5, solver, 1e-10);
                assert_eq!(audit.fault_count, 0, "{frame:?}{machine}{audit:?}");
                assert_eq!(audit.exclusion_reason, None);
                let unexplained = audit.unexplained_energy().abs();
                assert!(unexplained < 1e-6, "{frame:?}{machine}{audit:?}");
                audit.impact_energy
            });
            assert!(own < -0.01, "{machine}{own}");
            for loss in moving {
                assert!((loss - own).abs() < 1e-6, "{machine}{own} {loss}");
            }
        }
    }
}

#[test]
fn work_of_a_contact_in_a_moving_frame_equals_work_of_its_force() {
    // The coordinates of a ball at rest on the floor are relative to a frame that rises with V. In the inertial frame,
    // T + V is constant.
    let text = BALL
        .replace("initial = 0.5", "initial = 0, initial_rate = -1")
        .replace("[kinetic]", "[definitions]\nz = \"y + A*w*t\"\n[kinetic]")
        .replace("dot(y)", "dot(z)")
        .replace("m*g*y", "m*g*z")
        .replace("when = \"y\"", "when = \"z\"")
        .replace("A = { value = 0,", "A = { value = 0.05,");
    for solver in [Solver::Rk, Solver::Radau] {
        let audit = audit_of_text(&text, 2.0, solver, 1e-9);
        assert_eq!(audit.fault_count, 0, "{audit:?}");
        assert!(audit.work.abs() < 1e-9, "{audit:?}");
        assert!(audit.energy_change.abs() < 1e-9, "{audit:?}");
    }
}

/// A body comes to rest on the floor under a force that is not part of the potential energy. If all bounces are small,
/// the energy dissipated at the last bounce exceeds the errors of the solver.
#[test]
fn last_bounce_under_an_applied_force_gives_no_warning() {
    for speed in [0.3, 2.2e-7, -1.2e-7, 3.3e-9, -2.9e-9] {
        for restitution in [0.3, 0.38, 0.55, 0.63, 0.74, 0.9] {
            for (mass, force) in [
                (1.0, "-m*g"),
                (0.2, "-m*g*(1 + 0.5*sin(w*t))"),
                (7.0, "-m*g*(1 + 0.1*dot(y)/c)"),
            ] {
                let text = format!(
                    "[model]\nname = \"pressed\"\n[parameters]\nm = {{ value = {mass}, unit = \"kg\" }}\n\
                     g = {{ value = 9.81, unit = \"m/s^2\" }}\nw = {{ value = 3, unit = \"rad/s\" }}\n\
                     c = {{ value = 2, unit = \"m/s\" }}\n[coordinates]\n\
                     y = {{ unit = \"m\", initial_rate = {speed:?} }}\n\
                     [kinetic]\nT = \"1/2*m*dot(y)^2\"\n\
                     [forces]\npress = {{ on = \"y\", value = \"{force}\" }}\n\
                     [impacts]\nfloor = {{ when = \"y\", restitution = {restitution} }}\n"
                );
                let model = CompiledModel::from_text("pressed.toml", &text, Orders::Declared);
                let model = model.unwrap_or_else(|error| panic!("{error}"));
                for solver in [Solver::Rk, Solver::Radau] {
                    let audit = audit(&model, 3.0, solver, 1e-9);
                    let place = format!("{speed} {restitution} {force} {solver}: {audit:?}");
                    assert_eq!(audit.fault_count, 0, "{place}");
                    assert!(audit.impact_energy < 0.0, "{place}");
                    let rest = audit.unexplained_energy().abs();
                    assert!(rest < 1e-6 * 0.5 * mass * speed * speed, "{place}");
                }
            }
        }
    }
}

/// Asserts that the energy audit of a machine gives no warning with any general solver. Returns the largest number of
/// energy evaluations.
fn check_silent_audits(text: &str, until: f64) -> u64 {
    let model = CompiledModel::from_text("machine.toml", text, Orders::Declared);
    let model = model.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let evaluations = [Solver::Rk, Solver::Radau].map(|solver| {
        let audit = audit(&model, until, solver, 1e-9);
        assert!(!audit.has_failed(), "{solver}: {audit:?}\n{text}");
        audit.evaluations
    });
    evaluations[0].max(evaluations[1])
}

#[test]
fn start_from_rest_with_an_energy_gives_no_warning() {
    let potentials = [
        "k*d^2 + 1/2*k*x^2",
        "-k*d^2*cos(x/d)",
        "k*d^2*(1 - cos(x/d))",
        "1/2*k*(x - d)^2 + 1/2*k*(x + d)^2",
        "1/2*k*x^2 + m*g*x",
        "1/2*k*(sqrt(x^2 + l^2) - d)^2",
        "1e6*k*d^2 + 1/2*k*x^2",
    ];
    for potential in potentials {
        for force in ["A*sin(w*t)", "A*(1 - cos(w*t))", "A*w*t"] {
            for (d, rest) in [(0.2, "0"), (0.03, "-m*g/k")] {
                let text = format!(
                    "[model]\nname = \"rest\"\n[parameters]\nm = {{ value = 1.3, unit = \"kg\" }}\n\
                     k = {{ value = 70, unit = \"N/m\" }}\nA = {{ value = 2, unit = \"N\" }}\n\
                     w = {{ value = 3, unit = \"1/s\" }}\nd = {{ value = {d}, unit = \"m\" }}\n\
                     l = {{ value = 0.5, unit = \"m\" }}\ng = {{ value = 9.81, unit = \"m/s^2\" }}\n\
                     [coordinates]\nx = {{ unit = \"m\", initial = \"{rest}\" }}\n\
                     [kinetic]\nT = \"1/2*m*dot(x)^2\"\n[potential]\nV = \"{potential}\"\n\
                     [forces]\nF = {{ on = \"x\", value = \"{force}\" }}\n"
                );
                check_silent_audits(&text, 2.0);
            }
        }
    }
}

#[test]
fn block_sticking_by_two_frictions_gives_no_warning() {
    for (mass, amplitude, frequency, friction, weight, coefficient) in [
        (1.794, 2.746, 8.724, 0.512, 4.169, 0.209),
        (0.705, 6.618, 6.006, 1.247, 9.531, 0.396),
        (0.8, 4.733, 5.916, 0.184, 4.226, 0.4),
    ] {
        for scale in ["1", "10", "100", "0.001"] {
            let text = format!(
                "[model]\nname = \"block\"\n[parameters]\nm = {{ value = {mass}, unit = \"kg\" }}\n\
                 A = {{ value = {amplitude}, unit = \"N\" }}\nw = {{ value = {frequency}, unit = \"1/s\" }}\n\
                 F = {{ value = {friction}, unit = \"N\" }}\nN = {{ value = {weight}, unit = \"N\" }}\n\
                 mu = {{ value = {coefficient} }}\n[coordinates]\nX = {{ unit = \"m\" }}\nY = {{ unit = \"m\" }}\n\
                 [definitions]\nx = \"X/{scale}\"\ny = \"Y/{scale}\"\n\
                 [kinetic]\nT = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n\
                 [forces]\npress = {{ on = \"y\", value = \"-N\" }}\ndrive = {{ on = \"x\", value = \"A*sin(w*t)\" }}\n\
                 dry = {{ on = \"x\", value = \"-F*sign(dot(x))\" }}\n[impacts]\n\
                 floor = {{ when = \"y\", restitution = 0.2, friction = \"mu\", slip = \"dot(x)\" }}\n"
            );
            check_silent_audits(&text, 0.3);
        }
    }
}

#[test]
fn block_at_rest_on_a_running_belt_gives_no_warning() {
    for (mass, weight, friction, coefficient, speed, place) in [
        (0.747, 5.061, 1.534, 0.155, 0.495, 0.17),
        (1.3, 18.0, 3.1, 0.11, 0.9, 0.0),
        (0.4, 9.0, 0.8, 0.06, 0.21, 0.3),
    ] {
        let text = format!(
            "[model]\nname = \"belt\"\n[parameters]\nm = {{ value = {mass}, unit = \"kg\" }}\n\
             N = {{ value = {weight}, unit = \"N\" }}\nF = {{ value = {friction}, unit = \"N\" }}\n\
             mu = {{ value = {coefficient} }}\nv = {{ value = {speed}, unit = \"m/s\" }}\n[coordinates]\n\
             x = {{ unit = \"m\", initial = {place} }}\ny = {{ unit = \"m\" }}\n\
             [kinetic]\nT = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n\
             [forces]\npress = {{ on = \"y\", value = \"-N\" }}\ndry = {{ on = \"x\", value = \"-F*sign(dot(x))\" }}\n\
             [impacts]\nbelt = {{ when = \"y\", restitution = 0.8, friction = \"mu\", slip = \"dot(x) - v\" }}\n"
        );
        let evaluations = check_silent_audits(&text, 1.5);
        assert!(evaluations < 5000, "{evaluations}");
    }
}

#[test]
fn block_that_slides_from_rest_to_rest_gives_no_warning() {
    for amplitude in [3.0, 4.0, 5.0, 6.0, 8.0, 10.0] {
        for frequency in [1.0, 2.0, 3.0] {
            let text = format!(
                "[model]\nname = \"block\"\n[parameters]\nm = {{ value = 4, unit = \"kg\" }}\n\
                 c = {{ value = 12, unit = \"N s/m\" }}\nF = {{ value = 2.5, unit = \"N\" }}\n\
                 A = {{ value = {amplitude}, unit = \"N\" }}\nw = {{ value = {frequency}, unit = \"1/s\" }}\n\
                 [coordinates]\nx = {{ unit = \"m\" }}\n[kinetic]\nT = \"1/2*m*dot(x)^2\"\n\
                 [dissipation]\nR = \"1/2*c*dot(x)^2\"\n[forces]\n\
                 drive = {{ on = \"x\", value = \"A*sin(w*t)\" }}\n\
                 dry = {{ on = \"x\", value = \"-F*sign(dot(x))\" }}\n"
            );
            check_silent_audits(&text, 10.0);
        }
    }
}

/// The belt below a body at rest starts within 1 ms. Rounding errors of the time give the body an energy of 1e-22 J.
#[test]
fn body_on_a_belt_that_starts_steeply_gives_no_warning() {
    let text = r#"[model]
name = "belt"
[parameters]
m = { value = 1, unit = "kg" }
F = { value = 3, unit = "N" }
V = { value = 0.3, unit = "m/s" }
T = { value = 0.5, unit = "s" }
Q = { value = 1e-3, unit = "s" }
[coordinates]
x = { unit = "m" }
[kinetic]
body = "1/2*m*dot(x)^2"
[forces]
friction = { on = "x", value = "-F*sign(dot(x) - V*min(max((t - T)/Q, 0), 1))" }
"#;
    check_silent_audits(text, 1.0);
}
