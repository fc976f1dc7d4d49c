//! Requests of `simulate` that no motion meets, with the cause in the message.

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
[kinetic]
T = "1/2*m*dot(x)^2"
[potential]
V = "1/2*k*x^2"
[forces]
push = { on = "x", value = "u" }
"#;

/// Returns exit status and message of a simulation for 1 s.
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
fn overflowing_energy_has_no_warning_of_the_audit() {
    let (status, message) = simulate(&["--input", "u=1e300"]);
    assert_eq!(status, Some(1), "{message}");
    assert!(message.contains("`energy` is not finite"), "{message}");
    assert!(!message.contains("without work"), "{message}");
}
