//! Tests of solvers that stop: the program keeps the rows so far, prints the time, the quantity and a remedy, and exits
//! with status 1. Messages about friction appear only for friction.

use std::path::Path;
use std::process::Output;

use eomgen_tests::program::{run, run_accepted, text};

/// Mass on a spring that a belt drags by friction.
const BELT: &str = r#"
[model]
name = "belt"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 100, unit = "N/m" }
F = { value = 5, unit = "N" }
v = { value = 0.1, unit = "m/s" }
[coordinates]
x = { unit = "m" }
[kinetic]
T = "1/2*m*dot(x)^2"
[potential]
V = "1/2*k*x^2"
[forces]
belt = { on = "x", value = "-F*sign(dot(x) - v)" }
"#;

/// Returns a mass with a force law whose forces on both sides point to the middle.
fn between_forces(law: &str) -> String {
    format!(
        r#"
[model]
name = "chatter"
[parameters]
m = {{ value = 1, unit = "kg" }}
F = {{ value = 1, unit = "N" }}
D = {{ value = 0.5, unit = "N" }}
tau = {{ value = 0.1, unit = "s" }}
[coordinates]
x = {{ unit = "m", initial = 1 }}
[kinetic]
T = "1/2*m*dot(x)^2"
[forces]
relay = {{ on = "x", value = "{law}" }}
"#
    )
}

/// Cubic spring with negative stiffness: the motion diverges in finite time.
const BLOW_UP: &str = r#"
[model]
name = "blow_up"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 2, unit = "N/m^3" }
[coordinates]
x = { unit = "m", initial = 1 }
[kinetic]
T = "1/2*m*dot(x)^2"
[potential]
V = "-1/4*k*x^4"
"#;

/// Pendulum with smoothed dry friction that is so steep that the equations are very stiff.
const STIFF: &str = r#"
[model]
name = "stiff"
[parameters]
J = { value = 0.0135, unit = "kg m^2" }
T_g = { value = 0.44, unit = "N m" }
T_c = { value = 0.02, unit = "N m" }
v_0 = { value = 1e-9, unit = "rad/s" }
[coordinates]
theta = { unit = "rad", initial = 0.3 }
[kinetic]
bob = "1/2*J*dot(theta)^2"
[potential]
gravity = "-T_g*cos(theta)"
[forces]
friction = { on = "theta", value = "-T_c*tanh(dot(theta)/v_0)" }
"#;

/// Two chambers with an orifice and a piston that stops. At equal pressures the derivative of the flow is infinite.
const ORIFICE: &str = r#"
[model]
name = "orifice"
[parameters]
m = { value = 5, unit = "kg" }
k = { value = 2e4, unit = "N/m" }
A = { value = 1e-3, unit = "m^2" }
Q = { value = 2e-7, unit = "m^3/(s Pa^(1/2))" }
C = { value = 1e-12, unit = "m^3/Pa" }
[coordinates]
x = { unit = "m", initial = 0.02 }
[states]
p1 = { unit = "Pa", rate = "(A*dot(x) - Q*sign(p1 - p2)*sqrt(abs(p1 - p2)))/C", initial = 3e5 }
p2 = { unit = "Pa", rate = "(-A*dot(x) + Q*sign(p1 - p2)*sqrt(abs(p1 - p2)))/C", initial = 1e5 }
[kinetic]
T = "1/2*m*dot(x)^2"
[potential]
V = "1/2*k*x^2"
[forces]
p = { on = "x", value = "-(p1 - p2)*A" }
"#;

/// Turntable whose inertia is zero at one position of a slider.
const INDEFINITE: &str = r#"
[model]
name = "turntable"
[parameters]
m = { value = 1, unit = "kg" }
J = { value = 1, unit = "kg m^2" }
a = { value = 0.5, unit = "m" }
k = { value = 1, unit = "N m/rad" }
[coordinates]
x = { unit = "m", initial_rate = 1 }
phi = { unit = "rad" }
[kinetic]
slider = "1/2*m*dot(x)^2"
table = "1/2*J*(1 - x/a)*dot(phi)^2"
[potential]
spring = "1/2*k*phi^2"
"#;

struct StoppedRun {
    output: Output,
    rows: Vec<Vec<f64>>,
}

impl StoppedRun {
    fn message(&self) -> String {
        text(&self.output.stderr)
    }

    fn assert_says(&self, parts: &[&str]) {
        let message = self.message();
        for part in parts {
            assert!(message.contains(part), "{part} is not in: {message}");
        }
        assert!(!message.contains("panicked"), "{message}");
    }

    fn assert_omits(&self, parts: &[&str]) {
        let message = self.message();
        for part in parts {
            assert!(!message.contains(part), "{part} is in: {message}");
        }
    }

    fn last_time(&self) -> f64 {
        self.rows.last().expect("rows")[0]
    }
}

fn write_spec(folder: &Path, specification: &str) -> String {
    let path = folder.join("model.toml");
    std::fs::write(&path, specification).expect("a file");
    path.display().to_string()
}

fn run_until_stop(specification: &str, until: &str, more: &[&str]) -> StoppedRun {
    let folder = tempfile::tempdir().expect("a folder");
    let (spec, out) = (
        write_spec(folder.path(), specification),
        folder.path().join("a.csv"),
    );
    let shown = out.display().to_string();
    let arguments = ["simulate", &spec, "--until", until, "--out", &shown];
    let output = run(&[&arguments[..], more].concat());
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    let table = std::fs::read_to_string(&out).expect("the rows so far");
    let rows = table.lines().skip(1).map(|line| {
        let numbers = line
            .split(',')
            .map(|number| number.parse().expect("a number"));
        numbers.collect::<Vec<f64>>()
    });
    let rows: Vec<_> = rows.collect();
    assert!(rows.iter().flatten().all(|number| number.is_finite()));
    assert!(rows.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    StoppedRun { output, rows }
}

#[test]
fn sticking_with_adams_keeps_the_rows_so_far() {
    let found = run_until_stop(BELT, "2", &["--solver", "adams", "--interval", "0.001"]);
    // The belt's friction accelerates the mass to the belt's speed within 0.02 s.
    assert!(
        (0.015..0.025).contains(&found.last_time()),
        "{}",
        found.last_time()
    );
    assert!(found.rows.len() > 15);
    found.assert_says(&[
        "error: at t = 0.02",
        "`dot(x) - v`",
        "sticks",
        "tanh(v/v_0)",
    ]);
    let folder = tempfile::tempdir().expect("a folder");
    let (spec, out) = (write_spec(folder.path(), BELT), folder.path().join("a.csv"));
    let shown = out.display().to_string();
    for solver in ["auto", "exact", "rk", "radau"] {
        run_accepted(&[
            "simulate", &spec, "--until", "2", "--solver", solver, "--out", &shown,
        ]);
    }
}

#[test]
fn stopped_run_keeps_parquet_rows_and_gives_reason_in_json() {
    let folder = tempfile::tempdir().expect("a folder");
    let (spec, out) = (
        write_spec(folder.path(), BELT),
        folder.path().join("a.parquet"),
    );
    let shown = out.display().to_string();
    let output = run(&[
        "simulate",
        &spec,
        "--until",
        "2",
        "--interval",
        "0.001",
        "--solver",
        "adams",
        "--json",
        "--out",
        &shown,
    ]);
    assert_eq!(output.status.code(), Some(1));
    let bytes = std::fs::read(&out).expect("the rows so far");
    assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
    let document: serde_json::Value =
        serde_json::from_slice(&output.stdout).expect("one JSON document");
    let t = document["stopped"]["t"].as_f64().expect("a time");
    assert!((0.015..0.025).contains(&t), "{t}");
    assert!(
        document["stopped"]["reason"]
            .as_str()
            .expect("a reason")
            .contains("sticks")
    );
    assert!(document["rows"].as_u64().expect("a number") > 15);
    let done = run(&[
        "simulate", &spec, "--until", "0.01", "--json", "--out", &shown,
    ]);
    let document: serde_json::Value = serde_json::from_slice(&done.stdout).expect("JSON");
    assert!(document["stopped"].is_null());
}

#[test]
fn chattering_forces_are_not_reported_as_friction() {
    // The time between switches decreases to zero.
    let law = between_forces("-F*sign(x) - D*sign(dot(x))");
    let found = run_until_stop(&law, "60", &["--solver", "rk"]);
    found.assert_says(&["at t = ", "`x` is zero", "chatters"]);
    found.assert_omits(&["sticks", "friction", "tanh"]);
    assert!(found.rows.len() > 10 && found.last_time() > 5.0);
}

/// A relay with a lead term has a sliding mode on its switching surface, like dry friction.
#[test]
fn relay_with_lead_term_has_sliding_mode() {
    let folder = tempfile::tempdir().expect("a folder");
    let law = between_forces("-F*sign(x + tau*dot(x))");
    let spec = write_spec(folder.path(), &law);
    let of = |solver| {
        let out = folder.path().join(format!("{solver}.csv"));
        let shown = out.display().to_string();
        run_accepted(&[
            "simulate", &spec, "--until", "20", "--solver", solver, "--out", &shown,
        ]);
        let table = std::fs::read_to_string(&out).expect("a table");
        let of_row = |line: &str| -> Vec<f64> {
            let numbers = line
                .split(',')
                .map(|number| number.parse().expect("a number"));
            numbers.collect()
        };
        table.lines().skip(1).map(of_row).collect::<Vec<_>>()
    };
    let (exact, general) = (of("exact"), of("rk"));
    assert_eq!(exact.len(), general.len());
    for (one, other) in exact.iter().zip(&general) {
        assert!((one[1] - other[1]).abs() < 1e-6, "{one:?} {other:?}");
    }
    let last = &general[general.len() - 1];
    assert!((last[1] + 0.1 * last[2]).abs() < 1e-9, "{last:?}");
}

/// The switches accumulate at 6.3094 s. The rows before this time agree with the general solver.
#[test]
fn stopped_exact_solver_keeps_the_rows_so_far() {
    let law = between_forces("-F*sign(x) - D*sign(dot(x))");
    let of = |solver| run_until_stop(&law, "60", &["--solver", solver, "--interval", "0.01"]);
    let (exact, general) = (of("exact"), of("rk"));
    exact.assert_says(&["error: at t = 6.3"]);
    assert_eq!((exact.rows.len(), general.rows.len()), (631, 631));
    for (one, other) in exact.rows.iter().zip(&general.rows) {
        assert!((one[1] - other[1]).abs() < 1e-8, "{one:?} {other:?}");
    }
}

#[test]
fn diverging_motion_is_not_reported_as_friction() {
    for solver in ["auto", "rk", "adams", "radau"] {
        let found = run_until_stop(BLOW_UP, "20", &["--solver", solver, "--interval", "0.01"]);
        found.assert_says(&["at t = ", "`x"]);
        found.assert_omits(&["sticks", "friction", "tanh"]);
        // x'' = 2 x^3 from rest at 1 diverges at 1.31 s.
        assert!(
            (1.28..1.32).contains(&found.last_time()),
            "{}",
            found.last_time()
        );
    }
}

/// x'' = 100 x from rest at 1 m: x = cosh(10 t), x_dot = 10 sinh(10 t) overflows at 70.817 s.
#[test]
fn exact_solver_names_the_time_of_overflow() {
    let law = r#"
[model]
name = "unstable"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 100, unit = "N/m" }
[coordinates]
x = { unit = "m", initial = 1 }
[kinetic]
T = "1/2*m*dot(x)^2"
[potential]
V = "-1/2*k*x^2"
"#;
    let stop = (f64::MAX.ln() + 0.2_f64.ln()) / 10.0;
    let folder = tempfile::tempdir().expect("a folder");
    let spec = write_spec(folder.path(), law);
    for (solver, until, interval) in [("auto", "71", 1.0), ("exact", "1000", 0.1)] {
        let out = folder.path().join("a.csv");
        let (shown, every) = (out.display().to_string(), interval.to_string());
        let output = run(&[
            "simulate",
            &spec,
            "--until",
            until,
            "--out",
            &shown,
            "--solver",
            solver,
            "--interval",
            &every,
        ]);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert!(
            message.contains(&format!("the state diverged at t = {stop:.4}")),
            "{message}"
        );
        // The energy overflows earlier than the state.
        let table = std::fs::read_to_string(&out).expect("the rows so far");
        let rows: Vec<&str> = table.lines().skip(1).collect();
        assert_eq!(rows.len(), 1 + (stop / interval) as usize, "{message}");
        for (place, row) in rows.iter().enumerate() {
            let x: f64 = row.split(',').nth(1).expect("x").parse().expect("a number");
            let right = (10.0 * interval * place as f64).cosh();
            assert!((x / right - 1.0).abs() < 1e-11, "{row}");
        }
    }
}

#[test]
fn explicit_solvers_report_stiffness() {
    for solver in ["rk", "adams"] {
        let found = run_until_stop(STIFF, "100", &["--solver", solver]);
        found.assert_says(&["stiff", "`theta_dot`", "stopped at t = "]);
        found.assert_omits(&["sticks"]);
        assert!(!found.rows.is_empty());
    }
}

/// The solution of `auto` agrees with the solution for a friction that is a thousand times less steep: the pendulum
/// stops at the same time.
#[test]
fn auto_solves_stiff_friction_with_radau() {
    let folder = tempfile::tempdir().expect("a folder");
    let (spec, out) = (
        write_spec(folder.path(), STIFF),
        folder.path().join("a.csv"),
    );
    let shown = out.display().to_string();
    let output = run(&[
        "simulate",
        &spec,
        "--until",
        "10",
        "--interval",
        "0.1",
        "--json",
        "--out",
        &shown,
    ]);
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(
        said.contains("radau") && said.contains("`theta_dot` settles"),
        "{said}"
    );
    let document: serde_json::Value =
        serde_json::from_slice(&output.stdout).expect("one JSON document");
    assert_eq!(document["solver"], "radau");
    assert!(
        document["evaluations"].as_u64().expect("a number") < 30_000,
        "{document}"
    );
}

fn simulate_orifice(solver: &str) -> (serde_json::Value, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = write_spec(folder.path(), ORIFICE);
    let out = folder.path().join("a.csv").display().to_string();
    let output = run(&[
        "simulate", &spec, "--until", "1", "--solver", solver, "--json", "--out", &out,
    ]);
    let document = serde_json::from_slice(&output.stdout).expect("one JSON document");
    (document, text(&output.stderr))
}

#[test]
fn auto_uses_radau_at_stiff_orifice() {
    let evaluations = |document: &serde_json::Value| document["evaluations"].as_u64();
    let (radau, _) = simulate_orifice("radau");
    let (auto, note) = simulate_orifice("auto");
    assert_eq!(auto["solver"], "radau");
    assert!(
        note.contains("stiff near the surface where `p1 - p2`"),
        "{note}"
    );
    assert_eq!(evaluations(&auto), evaluations(&radau));
}

#[test]
fn loss_of_positive_definiteness_is_reported() {
    for solver in ["auto", "rk", "adams", "radau"] {
        let found = run_until_stop(INDEFINITE, "2", &["--solver", solver, "--interval", "0.01"]);
        found.assert_says(&["at t = 0.", "not positive definite", "`phi`"]);
        assert!(
            (0.4..=0.5).contains(&found.last_time()),
            "{}",
            found.last_time()
        );
        assert!(found.rows.len() > 40);
    }
}

/// The force is so large that the energy overflows.
#[test]
fn overflowing_energy_is_an_error() {
    let spec = r#"
[model]
name = "mass"
[parameters]
m = { value = 1, unit = "kg" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
[kinetic]
T = "1/2*m*dot(x)^2"
[forces]
push = { on = "x", value = "u" }
"#;
    let folder = tempfile::tempdir().expect("a folder");
    let spec = write_spec(folder.path(), spec);
    let out = folder.path().join("a.csv").display().to_string();
    let arguments = ["simulate", &spec, "--until", "1", "--out", &out];
    let output = run(&[&arguments[..], &["--input", "u=1e200"]].concat());
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(
        message
            .contains("error: `energy` is not finite in 1000 of 1001 rows, first at t = 0.001 s"),
        "{message}"
    );
}
