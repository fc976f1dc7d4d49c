//! Tests of requests of `simulate` that cannot be simulated; the message contains the cause.

use eomgen_tests::program::{run, text};

const MASS: &str = r#"
[model]
name = "mass"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 10, unit = "N/m" }
[coordinates]
x = { unit = "m", initial = 0.1 }
[inputs]
u = { unit = "N" }
[definitions]
pull = "k*x"
[kinetic]
T = "1/2*m*dot(x)^2"
[potential]
V = "1/2*k*x^2"
[forces]
push = { on = "x", value = "u" }
"#;

/// Runs a simulation of 1 s and returns exit status and message.
fn simulate(more: &[&str]) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("mass.toml");
    std::fs::write(&spec, MASS).expect("written");
    let (spec, out) = (
        spec.display().to_string(),
        folder.path().join("a.csv").display().to_string(),
    );
    let arguments = ["simulate", &spec, "--until", "1", "--out", &out];
    let output = run(&[&arguments[..], more].concat());
    (output.status.code(), text(&output.stderr))
}

#[test]
fn tolerances_out_of_range_are_rejected_by_every_solver() {
    for solver in ["auto", "exact", "rk", "radau", "adams"] {
        for tolerance in ["0", "-1", "nan", "1", "1e-20", "inf"] {
            let (status, message) = simulate(&["--solver", solver, "--tolerance", tolerance]);
            assert_eq!(status, Some(2), "{solver}, {tolerance}: {message}");
            assert!(
                message.contains("must be between 1e-14 and 0.1"),
                "{message}"
            );
        }
    }
}

#[test]
fn overflowing_energy_gives_no_audit_warning() {
    let (status, message) = simulate(&["--input", "u=1e300"]);
    assert_eq!(status, Some(1), "{message}");
    assert!(message.contains("`energy` is not finite"), "{message}");
    assert!(!message.contains("without work"), "{message}");
}

#[test]
fn input_that_depends_on_the_motion_is_rejected_with_location() {
    for (input, column) in [("u=x", 3), ("u=0.5*x", 7), ("u=1 - sin(3*x)", 13)] {
        let (status, message) = simulate(&["--input", input]);
        assert_eq!(status, Some(2), "{message}");
        let expected = "`x` is a coordinate: the input `u` is an expression of t and parameters";
        assert!(message.contains(expected), "{message}");
        assert!(
            message.contains(&format!("--input:1:{column}")),
            "{message}"
        );
        assert!(message.contains("[controllers]"), "{message}");
    }
    let (status, message) = simulate(&["--input", "u=2*pull"]);
    assert_eq!(status, Some(2), "{message}");
    assert!(
        message.contains("the definition `pull` depends on the motion"),
        "{message}"
    );
    assert!(message.contains("--input:1:5"), "{message}");
}

#[test]
fn wrong_units_of_inputs_are_rejected_with_location() {
    for (input, column, expected) in [
        ("u=5 mm", 5, "`u` is in N, not in mm"),
        ("u=5 foo", 5, "unknown unit `foo`"),
        ("u=(2 + 1) 2", 11, "unknown unit `2`"),
        ("u=k*0.1 N", 3, "this value already has a unit, "),
        ("u=2*k", 3, "`u` is in N, but this value is in "),
        ("u=3*m/m", 3, "`u` is in N, but this value is a pure number"),
    ] {
        let (status, message) = simulate(&["--input", input]);
        assert_eq!(status, Some(2), "{input}: {message}");
        assert!(message.contains(expected), "{input}: {message}");
        let place = format!("--input:1:{column}");
        assert!(message.contains(&place), "{input}: {message}");
    }
}

#[test]
fn unit_after_a_pure_number_of_parameters_is_that_of_the_input() {
    for input in ["u=2*m/m kN", "u=2e3*m/m N", "u=2 kN"] {
        let (status, message) = simulate(&["--input", input]);
        assert_eq!(status, Some(0), "{input}: {message}");
    }
}

#[test]
fn input_without_a_finite_value_is_named_with_its_time() {
    // Inputs are infinite at the start, in the middle or at the end, NaN from a time on, or infinite between steps.
    for (input, cause, status) in [
        ("u=1/t", "`u` is infinite at t = 0.0 s", 2),
        ("u=ln(t)", "`u` is infinite at t = 0.0 s", 2),
        ("u=1/(t - 0.5)", "`u` becomes infinite near t = 0.5", 1),
        ("u=tan(pi*t)", "`u` becomes infinite near t = 0.5", 1),
        ("u=1/(1 - t)", "`u` becomes infinite near t = 1", 1),
        (
            "u=sqrt(0.5 - t)",
            "`u` is not a number (NaN) after t = 0.5",
            1,
        ),
    ] {
        for solver in ["auto", "rk", "radau", "adams"] {
            let (found, message) = simulate(&["--solver", solver, "--input", input]);
            assert_eq!(found, Some(status), "{solver}, {input}: {message}");
            let is_named =
                message.contains(cause) || message.contains(&cause.replace("0.5", "0.4"));
            assert!(is_named, "{solver}, {input}: {message}");
            assert!(message.contains("simulate another time span"), "{message}");
            assert!(!message.contains("x_dot"), "{solver}, {input}: {message}");
        }
    }
    for solver in ["auto", "exact"] {
        let (status, message) = simulate(&["--solver", solver, "--input", "u=1/above(t - 0.5)"]);
        assert_eq!(status, Some(2), "{solver}: {message}");
        assert!(
            message.contains("the input `u` is infinite from t = 0.0 s on"),
            "{message}"
        );
    }
}

#[test]
fn prescribed_motion_with_an_infinite_rate_is_named_with_its_time() {
    let spec = MASS
        .replace("u = { unit = \"N\" }", "s = { unit = \"m\", rates = 2 }")
        .replace("1/2*m*dot(x)^2", "1/2*m*(dot(x) + dot(s))^2");
    let spec: String = spec
        .split_inclusive('\n')
        .filter(|line| !line.contains("\"u\"") && !line.starts_with("[forces]"))
        .collect();
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("base.toml");
    std::fs::write(&file, spec).expect("a file");
    for (motion, place) in [
        ("s=sqrt(t)", "at t = 0.0"),
        ("s=abs(t - 0.3)^1.2", "at t = 0.3"),
    ] {
        for solver in ["rk", "radau"] {
            let out = folder.path().join("out.csv").display().to_string();
            let spec = file.display().to_string();
            let output = run(&[
                "simulate", &spec, "--until", "1", "--solver", solver, "--input", motion, "--out",
                &out,
            ]);
            let message = text(&output.stderr);
            assert!(!output.status.success(), "{motion}: {message}");
            let named = format!("the rate or the second derivative of `s` is infinite {place}");
            let near = named.replace("0.3", "0.2");
            assert!(
                message.contains(&named) || message.contains(&near),
                "{motion}, {solver}: {message}"
            );
        }
    }
}

#[test]
fn finite_inputs_are_not_blamed_for_a_diverging_state() {
    let spec = MASS
        .replace("1/2*k*x^2", "-1/2*k*x^2/(1 - x/l)")
        .replace("k = {", "l = { value = 0.2, unit = \"m\" }\nk = {");
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("singular.toml");
    std::fs::write(&file, spec).expect("written");
    let out = folder.path().join("a.csv").display().to_string();
    let arguments = [
        "simulate",
        &file.display().to_string(),
        "--until",
        "9",
        "--out",
        &out,
        "--input",
        "u=10*above(t)",
    ];
    let message = text(&run(&arguments).stderr);
    assert!(
        message.contains("x_dot") && !message.contains("`u`"),
        "{message}"
    );
}
