//! Tests of inputs that are functions of time: second derivatives in forces and observables, and steps at samples of
//! controllers.

use eomgen_tests::program::run_accepted;

/// Simulates a specification and returns a column of the result.
fn simulate(text: &str, options: &[&str], column: &str) -> Vec<f64> {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name).display().to_string();
    let (spec, table) = (place("machine.toml"), place("motion.csv"));
    std::fs::write(&spec, text).expect("written");
    let given = ["simulate", &spec, "--out", &table];
    run_accepted(&[&given[..], options].concat());
    let mut reader = csv::Reader::from_path(&table).expect("a table");
    let headers = reader.headers().expect("a header");
    let place = headers.iter().position(|name| name == column);
    let place = place.expect("a column");
    let rows = reader.records().map(|row| row.expect("a row"));
    rows.map(|row| row[place].parse().expect("a number"))
        .collect()
}

#[test]
fn second_rate_of_an_expression_acts_in_forces_and_observables() {
    let text = r#"
[model]
name = "relative"
[parameters]
m = { value = 2, unit = "kg" }
c = { value = 3, unit = "m/s^2" }
[coordinates]
x = { unit = "m" }
[inputs]
s = { unit = "m", rates = 2 }
[kinetic]
mass = "1/2*m*dot(x)^2"
[forces]
inertia = { on = "x", value = "-m*s_ddot" }
[observables]
second = "s_ddot"
"#;
    // x'' = -s'', from rest: x(t) = s(0) + s'(0) t - s(t).
    for (input, value, second) in [
        (
            "s=0.2*sin(2*t)",
            (|t: f64| 0.4 * t - 0.2 * (2.0 * t).sin()) as fn(f64) -> f64,
            (|t: f64| -0.8 * (2.0 * t).sin()) as fn(f64) -> f64,
        ),
        ("s=c*t^2/2", |t| -1.5 * t * t, |_| 3.0),
        ("s=0.3 m", |_| 0.0, |_| 0.0),
    ] {
        for solver in ["rk", "radau", "auto"] {
            let options = ["--until", "1", "--interval", "0.25", "--solver", solver];
            let options = [&options[..], &["--input", input]].concat();
            let (x, found) = (
                simulate(text, &options, "x"),
                simulate(text, &options, "second"),
            );
            assert_eq!(x.len(), 5);
            for (row, (x, found)) in x.iter().zip(found).enumerate() {
                let t = 0.25 * row as f64;
                let subject = format!("{input}, {solver}, t = {t}");
                assert!((x - value(t)).abs() < 1e-8, "{subject}: {x}");
                assert!((found - second(t)).abs() < 1e-12, "{subject}: {found}");
            }
        }
    }
}

#[test]
fn samples_of_controllers_use_the_input_before_its_step() {
    let text = r#"
[model]
name = "sampled"
[parameters]
m = { value = 1, unit = "kg" }
T = { value = 0.1, unit = "s" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
w = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[forces]
push = { on = "x", value = "u + w" }
[controllers.hold]
period = "T"
states = { s = { unit = "N", next = "u" } }
outputs = { w = "u" }
"#;
    for (input, expected) in [
        ("u=above(t-0.1)", [0.0, 0.0, 1.0, 1.0]),
        ("u=1-above(t-0.1)", [1.0, 1.0, 0.0, 0.0]),
        ("u=above(t-0.1)+0*t", [0.0, 0.0, 1.0, 1.0]),
        ("u=1-above(t-0.1)+0*t", [1.0, 1.0, 0.0, 0.0]),
        ("u=2+above(t-0.1)+above(t-0.2)", [2.0, 2.0, 3.0, 4.0]),
    ] {
        for solver in [&["rk"][..], &["fixed", "--step", "0.01"]] {
            let options = [
                "--until",
                "0.3",
                "--interval",
                "0.1",
                "--input",
                input,
                "--solver",
            ];
            let found = simulate(text, &[&options[..], solver].concat(), "s");
            assert_eq!(found, expected, "{input}, {solver:?}");
        }
    }
}

/// A body is at rest on a belt that starts at 1 s. The body slides until it has the speed of the belt; then it sticks
/// to the belt.
#[test]
fn friction_sticks_on_a_belt_with_a_speed_step() {
    let text = r#"[model]
name = "belt"
[parameters]
m = { value = 2, unit = "kg" }
F = { value = 3, unit = "N" }
[coordinates]
x = { unit = "m" }
[inputs]
v = { unit = "m/s" }
[kinetic]
body = "1/2*m*dot(x)^2"
[forces]
friction = { on = "x", value = "-F*sign(dot(x) - v)" }
"#;
    let (speed, acceleration) = (0.3, 1.5);
    let lost = speed * speed / (2.0 * acceleration);
    for solver in ["auto", "rk", "radau"] {
        let options = [
            "--input",
            "v=0.3*above(t - 1)",
            "--until",
            "2",
            "--sample",
            "0.5",
            "--solver",
            solver,
        ];
        let places = simulate(text, &options, "x");
        for (place, t) in places.iter().zip([0.0, 0.5, 1.0, 1.5, 2.0]) {
            let expected = match t > 1.0 {
                true => speed * (t - 1.0) - lost,
                false => 0.0,
            };
            assert!(
                (place - expected).abs() < 1e-8,
                "{solver}: {place} {expected}"
            );
        }
    }
}

/// The speed of the belt is piecewise constant although a force varies; the body sticks to the belt all the time.
#[test]
fn stepped_inputs_are_held_if_others_vary() {
    let text = r#"[model]
name = "belt"
[parameters]
m = { value = 2, unit = "kg" }
F = { value = 3, unit = "N" }
[coordinates]
x = { unit = "m", initial_rate = 0.2 }
[inputs]
v = { unit = "m/s" }
f = { unit = "N" }
rest = { unit = "N" }
[kinetic]
body = "1/2*m*dot(x)^2"
[forces]
friction = { on = "x", value = "-F*sign(dot(x) - v)" }
load = { on = "x", value = "f + rest" }
"#;
    for solver in ["rk", "radau"] {
        let options = [
            "--input",
            "v=0.2 - 0.1*above(t - 3)",
            "--input",
            "f=2*sin(3*t)",
            "--until",
            "2",
            "--sample",
            "1",
            "--solver",
            solver,
        ];
        let places = simulate(text, &options, "x");
        for (place, t) in places.iter().zip([0.0, 1.0, 2.0]) {
            assert!((place - 0.2 * t).abs() < 1e-9, "{solver}: {place} at {t} s");
        }
    }
}
