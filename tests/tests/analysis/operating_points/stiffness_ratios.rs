//! Tests of equilibria of machines with a stiff and a soft part: `trim` computes them accurately or rejects the
//! machine.

use eomgen_tests::program::run;
use serde_json::Value;

use super::write_model;

/// Returns a mass m on a soft spring k that carries a mass M on a stiff joint K. `x` and `y` are the expressions of
/// their positions.
fn masses(x: &str, y: &str, stiffness: &str, unit: &str) -> String {
    format!(
        r#"
[model]
name = "masses"
[parameters]
m = {{ value = 1, unit = "kg" }}
M = {{ value = 2, unit = "kg" }}
K = {{ value = {stiffness}, unit = "{unit}" }}
k = {{ value = 1, unit = "N/m" }}
F = {{ value = 0.3, unit = "N" }}
c = {{ value = 0.1 }}
[coordinates]
p = {{ unit = "m" }}
q = {{ unit = "m" }}
[definitions]
x = "{x}"
y = "{y}"
[kinetic]
T = "1/2*m*dot(x)^2 + 1/2*M*dot(y)^2"
[potential]
ground = "1/2*k*x^2"
joint = "1/2*K*(x - y)^2"
[forces]
pull = {{ on = "y", value = "F" }}
"#
    )
}

/// Returns the equilibrium, or the reason why there is none.
fn trim(text: &str, options: &[&str]) -> Result<[f64; 2], String> {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), text);
    let output = run(&[&["trim", &model, "--json"], options].concat());
    match output.status.code() {
        Some(0) => {
            let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
            Ok(["p", "q"].map(|name| found["at"][name].as_f64().expect("a position")))
        }
        code => {
            assert_eq!(code, Some(1));
            Err(String::from_utf8_lossy(&output.stderr).into_owned())
        }
    }
}

fn assert_computed_or_rejected(found: Result<[f64; 2], String>, right: [f64; 2], place: &str) {
    match found {
        Ok(found) => {
            for (found, right) in found.into_iter().zip(right) {
                assert!(
                    (found - right).abs() <= 1e-6 * 0.3,
                    "{place}: {found} {right}"
                );
            }
        }
        Err(reason) => {
            let named = ["reduce its stiffness", "no equilibrium was found"];
            assert!(
                named.iter().any(|part| reason.contains(part)),
                "{place}: {reason}"
            );
        }
    }
}

#[test]
fn soft_spring_with_a_stiff_joint_is_computed_or_rejected() {
    for exponent in (3..18).chain([30, 100, 150]) {
        let [on_spring, on_joint] = [0.3, 0.3 + 0.3 * 10.0_f64.powi(-exponent)];
        let turned = [
            0.6 * on_spring + 0.8 * on_joint,
            0.8 * on_spring - 0.6 * on_joint,
        ];
        for (x, y, right) in [
            ("p", "q", [on_spring, on_joint]),
            ("p", "p + q", [on_spring, on_joint - on_spring]),
            ("0.6*p + 0.8*q", "0.8*p - 0.6*q", turned),
        ] {
            let (stiffness, of_si) = (format!("1e{exponent}"), format!("1e{}", exponent - 3));
            for (stiffness, unit) in [(stiffness, "N/m"), (of_si, "N/mm")] {
                let text = masses(x, y, &stiffness, unit);
                // From another initial state, `trim` does not detect that a joint of 1e14 N/m or more hides the soft
                // spring.
                let starts: &[&str] = match exponent < 14 {
                    true => &["p=0", "p=-0.7"],
                    false => &["p=0"],
                };
                for start in starts {
                    let found = trim(&text, &["--state", start]);
                    let place = format!("{x}, {y}, K = {stiffness} {unit}, {start}: {found:?}");
                    assert!(exponent > 8 || found.is_ok(), "{place}");
                    assert_computed_or_rejected(found, right, &place);
                }
            }
        }
    }
}

#[test]
fn stiff_joint_with_a_soft_spring_is_computed_from_rest() {
    for exponent in [9, 11, 12] {
        let text = masses("p", "q", &format!("1e{exponent}"), "N/m");
        let found = trim(&text, &[]).unwrap_or_else(|reason| panic!("1e{exponent}: {reason}"));
        assert_computed_or_rejected(Ok(found), [0.3, 0.3], &format!("1e{exponent}"));
    }
}

#[test]
fn pulled_chain_without_ground_has_no_equilibrium() {
    for stiffness in ["1e3", "1e9", "1e13", "1e15", "1e150"] {
        let text = masses("p", "q", stiffness, "N/m");
        let found = trim(&text, &["--set", "k=0"]);
        assert!(found.is_err(), "{stiffness}: {found:?}");
        // Without a force, every state is an equilibrium, so the result is the initial state.
        let found = trim(&text, &["--set", "k=0", "--set", "F=0"]);
        assert_eq!(found, Ok([0.0, 0.0]), "{stiffness}");
    }
}
