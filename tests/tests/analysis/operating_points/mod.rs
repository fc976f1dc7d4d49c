//! Comparison of `linearise`, `modes`, `trim`, and inputs and initial states of `simulate` with closed forms.

mod bases;
mod constrained;
mod discrete;
mod drawn_modes;
mod from_rest;
mod given;
mod growth;
mod lost_stiffness;
mod nonlinear;
mod singular;
mod stiffness_ratios;
mod tables;

use std::f64::consts::{PI, TAU};
use std::path::Path;

use eomgen_tests::models::path;
use eomgen_tests::program::{run, run_accepted, run_rejected};
use serde_json::Value;

fn shipped(name: &str) -> String {
    path(name).display().to_string()
}

fn write_model(folder: &Path, text: &str) -> String {
    let file = folder.join("model.toml");
    std::fs::write(&file, text).expect("written");
    file.display().to_string()
}

fn run_json(arguments: &[&str]) -> Value {
    serde_json::from_str(&run_accepted(arguments)).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter().map(|v| v.as_f64().expect("a number")).collect()
}

const OSCILLATOR: &str = r#"
[model]
name = "oscillator"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 50, unit = "N/m" }
F_0 = { value = 3, unit = "N" }
w_0 = { value = 2, unit = "rad/s" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[forces]
motor = { on = "x", value = "u" }
[observables]
pull = { value = "k*x", unit = "N" }
"#;

/// Clamped-free beam.
const BEAM: &str = r#"
[model]
name = "beam"
[parameters]
mu = { value = 0.6, unit = "kg/m" }
B = { value = 4, unit = "N m^2" }
l = { value = 1.2, unit = "m" }
[fields.w]
along = "x"
from = 0
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 5
unit = "m"
[kinetic]
beam = "1/2*integral(mu*dot(w)^2, w)"
[potential]
bending = "1/2*integral(B*diff(w, x, 2)^2, w)"
"#;

#[test]
fn linearisation_matches_closed_form() {
    let found = run_json(&[
        "linearise",
        &shipped("pendulum"),
        "--state",
        "theta=0",
        "--json",
    ]);
    assert_eq!(found["schema"], 2);
    assert_eq!(found["order"], 0);
    let states: Vec<&str> = found["states"]
        .as_array()
        .expect("a list")
        .iter()
        .flat_map(Value::as_str)
        .collect();
    assert_eq!(states, ["theta", "theta_dot"]);
    assert_eq!(found["at"]["theta"], 0.0);
    assert_eq!(
        found["units"]["states"],
        serde_json::json!(["rad", "rad/s"])
    );
    let a: Vec<Vec<f64>> = found["A"]
        .as_array()
        .expect("rows")
        .iter()
        .map(numbers)
        .collect();
    assert_eq!(a[0], [0.0, 1.0]);
    // In the upright position the square of the hanging frequency has the opposite sign.
    let at = format!("theta={PI}");
    let hanging = run_json(&["modes", &shipped("pendulum"), "--state", &at, "--json"]);
    let mode = &hanging["modes"][0];
    let omega = TAU * mode["frequency"].as_f64().expect("Hz");
    assert!(
        (a[1][0] / omega.powi(2) - 1.0).abs() < 1e-9,
        "{a:?} {omega}"
    );
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), OSCILLATOR);
    let found = run_json(&["linearise", &model, "--set", "k=18"]);
    for (matrix, right) in [
        ("A", serde_json::json!([[0.0, 1.0], [-9.0, 0.0]])),
        ("B", serde_json::json!([[0.0], [0.5]])),
    ] {
        let same = found[matrix]
            .as_array()
            .expect("rows")
            .iter()
            .zip(right.as_array().expect("rows"));
        for (row, right) in same {
            assert_eq!(numbers(row), numbers(right), "{matrix}");
        }
    }
    assert_eq!(numbers(&found["C"][0]), [18.0, 0.0]);
    assert_eq!(numbers(&found["D"][0]), [0.0]);
    let out = folder.path().join("linear.json").display().to_string();
    let said = run_accepted(&["linearise", &model, "--set", "k=18", "--out", &out]);
    assert!(said.contains("2 states, 1 input, "), "{said}");
    let file: Value = serde_json::from_slice(&std::fs::read(&out).expect("a file")).expect("JSON");
    assert_eq!(file, found);
}

#[test]
fn modes_match_textbooks() {
    let folder = tempfile::tempdir().expect("a folder");
    let beam = write_model(folder.path(), BEAM);
    let found = run_json(&["modes", &beam, "--json"]);
    let modes = found["modes"].as_array().expect("modes");
    assert_eq!(modes.len(), 5);
    // Roots of cosh(b) cos(b) = -1 (Rao, Mechanical Vibrations, 8.5).
    for (mode, root) in modes.iter().zip([
        1.875_104_068_711_961,
        4.694_091_132_974_175,
        7.854_757_438_237_613,
    ]) {
        let right = (root / 1.2_f64).powi(2) * (4.0_f64 / 0.6).sqrt() / TAU;
        let frequency = mode["frequency"].as_f64().expect("Hz");
        assert!(
            (frequency / right - 1.0).abs() < 1e-9,
            "{frequency} {right}"
        );
        assert_eq!(mode["damping"], 0.0);
    }
    // Without friction the hub turns freely: the first mode is a rigid-body motion, followed by the modes of the beam.
    let hub = run_json(&[
        "modes",
        &shipped("hub_beam_tip_mass"),
        "--set",
        "c=0",
        "--json",
    ]);
    let frequencies: Vec<f64> = hub["modes"]
        .as_array()
        .expect("modes")
        .iter()
        .map(|mode| mode["frequency"].as_f64().expect("Hz"))
        .collect();
    assert_eq!(frequencies.len(), 4);
    assert!(
        frequencies[0] == 0.0 && frequencies[1] > 1.0,
        "{frequencies:?}"
    );
    assert!(frequencies.is_sorted());
    let rigid = numbers(&hub["modes"][0]["shape"]);
    assert!(
        rigid[0] == 1.0 && rigid[1..].iter().all(|q| q.abs() < 1e-9),
        "{rigid:?}"
    );
    let table = run_accepted(&["modes", &beam, "--order", "2"]);
    assert_eq!(table.lines().count(), 3, "{table}");
}

#[test]
fn equilibria_match_closed_form() {
    // The angle is measured from upright; the initial angle 3/4 pi is closer to the hanging equilibrium.
    let hanging = run_json(&["trim", &shipped("pendulum"), "--json"]);
    let theta = hanging["at"]["theta"].as_f64().expect("an angle");
    assert!((theta - PI).abs() < 1e-9, "{hanging}");
    assert_eq!(hanging["stability"], "asymptotically stable");
    let spec = shipped("furuta_pendulum");
    // The initial angle of 3 rad is close to the upright equilibrium.
    let upright = run_json(&["trim", &spec]);
    let theta = upright["at"]["theta"].as_f64().expect("an angle");
    assert!((theta - PI).abs() < 1e-9);
    assert_eq!(upright["stability"], "unstable");
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), OSCILLATOR);
    let held = run_json(&["trim", &model, "--fix", "x=0.1"]);
    assert!((held["at"]["u"].as_f64().expect("a force") - 5.0).abs() < 1e-12);
    assert_eq!(held["stability"], "marginal");
    let loaded = run_json(&["trim", &model, "--fix", "u=5"]);
    assert!((loaded["at"]["x"].as_f64().expect("a place") - 0.1).abs() < 1e-13);
    let none = run(&["trim", &spec, "--fix", "theta=1.5", "--fix", "u=0"]);
    assert_eq!(none.status.code(), Some(1));
    let said = String::from_utf8_lossy(&none.stderr).into_owned();
    assert!(said.contains("no equilibrium was found"), "{said}");
}

#[test]
fn inputs_with_steps_are_simulated_exactly() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), OSCILLATOR);
    let out = folder.path().join("stepped.csv").display().to_string();
    let simulate = |input: &str| {
        let arguments = ["simulate", &model, "--until", "3", "--interval", "0.01"];
        let more = ["--input", input, "--out", &out, "--json"];
        let summary = run_json(&[&arguments[..], &more].concat());
        (
            summary["solver"].as_str().expect("a name").to_owned(),
            columns(Path::new(&out), &["t", "x"]),
        )
    };
    let omega = 5.0_f64;
    for (input, end) in [
        ("u=10*above(t - 0.5)", f64::INFINITY),
        ("u=10*(above(t - 0.5) - above(2*t - 4))", 2.0),
    ] {
        let (solver, rows) = simulate(input);
        assert_eq!(solver, "exact", "{input}");
        for row in rows {
            let response = |from: f64| match row[0] > from {
                true => 0.2 * (1.0 - (omega * (row[0] - from)).cos()),
                false => 0.0,
            };
            let right = response(0.5) - response(end);
            assert!((row[1] - right).abs() < 1e-13, "{input} {row:?} {right}");
        }
    }
    let (solver, _) = simulate("u=10*above(t - 0.5)*t");
    assert_eq!(solver, "rk");
}

#[test]
fn equilibrium_is_printed_as_a_table_with_units() {
    let spec = shipped("pendulum");
    let output = run(&["trim", &spec, "--table"]);
    let table = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0), "{table}");
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("theta   3.14159 rad"), "{table}");
    assert_eq!(table.lines().last(), Some("asymptotically stable"));
    let both = run(&["trim", &spec, "--table", "--json"]);
    assert_eq!(both.status.code(), Some(2));
}

#[test]
fn amplitudes_of_several_units_are_labelled() {
    let spec = eomgen_tests::models::project().join("examples/recipes/hydraulic_axis.toml");
    let spec = spec.display().to_string();
    let output = run(&["modes", &spec]);
    let table = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        table.contains("p_b 5.7939e9 Pa at 1 deg, x 1.0000 m, p_a"),
        "{table}"
    );
    let found = run_json(&["modes", &spec, "--json"]);
    let units = found["units"]["coordinates"].as_array().expect("units");
    assert_eq!(
        units.len(),
        found["coordinates"].as_array().expect("names").len()
    );
    assert_eq!(
        (&units[0], &units[1]),
        (&"m".into(), &"Pa".into()),
        "{found}"
    );
}

fn columns(file: &Path, names: &[&str]) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(file).expect("a file");
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let places = names.iter().map(|name| {
        header
            .iter()
            .position(|known| known == name)
            .expect("a column")
    });
    let places: Vec<usize> = places.collect();
    let row = |line: &str| -> Vec<f64> {
        let cells: Vec<&str> = line.split(',').collect();
        places
            .iter()
            .map(|place| cells[*place].parse().expect("a number"))
            .collect()
    };
    lines.map(row).collect()
}

#[test]
fn inputs_follow_expressions_and_initial_states_are_set() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), OSCILLATOR);
    let out = folder.path().join("motion.csv");
    let figure = folder.path().join("motion.svg");
    let simulate = |options: &[&str]| {
        let (out, figure) = (out.display().to_string(), figure.display().to_string());
        let given = [
            "simulate",
            &model,
            "--until",
            "3",
            "--interval",
            "0.01",
            "--out",
            &out,
            "--plot",
            &figure,
        ];
        run_accepted(&[&given, options].concat());
        columns(Path::new(&out), &["t", "x", "pull"])
    };
    let omega = 5.0_f64;
    for solver in ["auto", "rk"] {
        // Response to a step of 10 N at 0.5 s: x = (F/k)(1 - cos(omega (t - 0.5))).
        for row in simulate(&["--input", "u=10*above(t - 0.5)", "--solver", solver]) {
            let after = (row[0] - 0.5).max(0.0);
            let right = 0.2 * (1.0 - (omega * after).cos());
            assert!((row[1] - right).abs() < 2e-8, "{solver} {row:?} {right}");
        }
        // Input 3 sin(2 t), written with numbers and with parameters. The response is x = F/(k - m w^2) (sin(w t) -
        // w/omega sin(omega t)).
        for input in ["u=3*sin(2*t)", "u=F_0*sin(w_0*t)"] {
            for row in simulate(&[
                "--input",
                input,
                "--state",
                "x=0.1",
                "--state",
                "x_dot=-0.5",
                "--solver",
                solver,
            ]) {
                let t = row[0];
                let free = 0.1 * (omega * t).cos() - 0.1 * (omega * t).sin();
                let forced = 3.0 / 42.0 * ((2.0 * t).sin() - 0.4 * (omega * t).sin());
                assert!(
                    (row[1] - free - forced).abs() < 2e-8,
                    "{solver} {input} {row:?}"
                );
                assert!((row[2] - 50.0 * row[1]).abs() < 1e-12);
            }
        }
    }
    let svg = std::fs::read_to_string(&figure).expect("a figure");
    assert!(
        svg.starts_with("<svg") && svg.contains("pull"),
        "{}",
        &svg[..200]
    );
}

#[test]
fn invalid_options_are_rejected_with_suggestion() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), OSCILLATOR);
    let out = folder.path().join("none.csv").display().to_string();
    let simulate = ["simulate", &model, "--until", "1", "--out", &out];
    for (arguments, part) in [
        (
            &["linearise", &model, "--state", "xx=1"][..],
            "did you mean `x`",
        ),
        (&["linearise", &model, "--state", "x"], "NAME=VALUE"),
        (&["linearise", &model, "--state", "x=nan"], "finite"),
        (&["modes", &model, "--state", "x=1 kg"], "--state:1:5"),
        (
            &["modes", &model, "--state", "y=trim"],
            "no state and no input",
        ),
        (
            &["trim", &model, "--fix", "x_dot=1"],
            "a rate is nonzero only if",
        ),
        (
            &["linearise", &shipped("pendulum"), "--set", "g=1e308"],
            "not finite",
        ),
        (
            &["modes", &shipped("pendulum"), "--state", "theta=1e300"],
            "theta = 1e300 (SI) is out of range",
        ),
        (
            &["trim", &model, "--fix", "pull=1"],
            "no state and no input",
        ),
    ] {
        let said = run_rejected(arguments);
        assert!(said.contains(part), "{arguments:?}: {said}");
    }
    for (option, value, part) in [
        ("--input", "v=1", "no input `v`"),
        ("--input", "u", "expected NAME=VALUE"),
        ("--input", "u=3*sin(", "--input:1:9"),
        ("--input", "u=t>0.2", "above(x - a)"),
        ("--input", "u=1 if t", "above(x - a)*A"),
        ("--input", "u=k", "N"),
        ("--input", "u=F_0*sin(3*t)", "--input:1:11"),
        ("--input", "u=x_0*t", "x_0"),
        ("--input", "u=u", "--input:1:3"),
        ("--state", "u=1", "expected a coordinate"),
        ("--state", "x=inf", "finite"),
    ] {
        let said = run_rejected(&[&simulate[..], &[option, value]].concat());
        assert!(said.contains(part), "{option} {value}: {said}");
        assert!(!Path::new(&out).exists(), "{option} {value}");
    }
}
