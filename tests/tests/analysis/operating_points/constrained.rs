//! Comparison of modes and equilibria of machines with constraints with closed forms.

use super::{numbers, run_json, write_model};

const GRAVITY: f64 = 9.81;

/// Returns the specification of two masses in Cartesian coordinates, joined by rods.
fn masses(masses: [&str; 2], initial: [&str; 4], constraints: [&str; 2]) -> String {
    let [x_0, y_0, x_1, y_1] = initial;
    format!(
        r#"
[model]
name = "masses"
[parameters]
g = {{ value = {GRAVITY}, unit = "m/s^2" }}
m_0 = {{ value = {}, unit = "kg" }}
m_1 = {{ value = {}, unit = "kg" }}
l = {{ value = 3, unit = "m" }}
k = {{ value = 0.3, unit = "m" }}
[coordinates]
x_0 = {{ unit = "m", initial = "{x_0}" }}
y_0 = {{ unit = "m", initial = "{y_0}" }}
x_1 = {{ unit = "m", initial = "{x_1}" }}
y_1 = {{ unit = "m", initial = "{y_1}" }}
[kinetic]
masses = "1/2*m_0*(dot(x_0)^2 + dot(y_0)^2) + 1/2*m_1*(dot(x_1)^2 + dot(y_1)^2)"
[potential]
weight = "m_0*g*y_0 + m_1*g*y_1"
[constraints]
a = {{ zero = "{}" }}
b = {{ zero = "{}" }}
"#,
        masses[0], masses[1], constraints[0], constraints[1]
    )
}

const LONG_ROD: &str = "x_0^2 + y_0^2 - l^2";

/// Returns the eigenvalues that `modes` prints for a state.
fn eigenvalues(text: &str, arguments: &[&str]) -> Vec<[f64; 2]> {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), text);
    let document = run_json(&[&["modes", &model, "--json"], arguments].concat());
    let modes = document["modes"].as_array().expect("modes").iter();
    let part = |value: &serde_json::Value| value.as_f64().expect("a number");
    let eigenvalues = modes.map(|mode| &mode["eigenvalue"]);
    eigenvalues
        .map(|value| [part(&value[0]), part(&value[1])])
        .collect()
}

#[test]
fn modes_of_a_rod_on_an_upright_rod_match_their_pendulum() {
    for rod in [
        "sqrt((x_1 - x_0)^2 + (y_1 - y_0)^2) - k",
        "(x_1 - x_0)^2 + (y_1 - y_0)^2 - k^2",
    ] {
        let text = masses(["1", "1"], ["0", "l", "0", "l - k"], [LONG_ROD, rod]);
        let found = eigenvalues(&text, &[]);
        // In x_0 and x_1: -x'' = K x with K = (g/k - 2g/l, -g/k; -g/k, g/k).
        let (long, short) = (2.0 * GRAVITY / 3.0, GRAVITY / 0.3);
        let (mean, half) = (short - 0.5 * long, 0.5 * long);
        let root = half.hypot(short);
        let growing = (root - mean).sqrt();
        let right = [[growing, 0.0], [-growing, 0.0], [0.0, (mean + root).sqrt()]];
        assert_eq!(found.len(), 3, "{rod}: {found:?}");
        for right in right {
            let distance = |own: &[f64; 2]| (own[0] - right[0]).hypot(own[1] - right[1]);
            let nearest = found.iter().map(distance).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-9, "{rod}: {right:?} in {found:?}");
        }
    }
}

#[test]
fn damped_bead_on_a_level_ring_has_two_modes() {
    let text = r#"
[model]
name = "bead"
[parameters]
g = { value = 9.81, unit = "m/s^2" }
m = { value = 0.02, unit = "kg" }
l = { value = 1.8325, unit = "m" }
c = { value = 4.59, unit = "N s/m" }
h = { value = -1.39, unit = "m" }
[coordinates]
x = { unit = "m", initial = 0.7 }
y = { unit = "m", initial = "h" }
z = { unit = "m", initial = 0.96 }
[kinetic]
bead = "1/2*m*(dot(x)^2 + dot(y)^2 + dot(z)^2)"
[potential]
weight = "m*g*y"
[dissipation]
drag = "1/2*c*(dot(x)^2 + dot(y)^2 + dot(z)^2)"
[constraints]
sphere = { zero = "x^2 + y^2 + z^2 - l^2" }
height = { zero = "y - h" }
"#;
    let found = eigenvalues(text, &["--state", "trim"]);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0][0].abs() < 1e-12 && found[0][1] == 0.0, "{found:?}");
    assert!((found[1][0] + 4.59 / 0.02).abs() < 1e-9, "{found:?}");
}

#[test]
fn chain_of_very_different_masses_hangs_in_equilibrium() {
    let rod = "(x_1 - x_0)^2 + (y_1 - y_0)^2 - k^2";
    for light in ["1", "1e-3", "1e-5"] {
        let start = ["0.17*l", "-0.98*l", "0.2*l", "-0.97*l - k"];
        let text = masses([light, "1000"], start, [LONG_ROD, rod]);
        let folder = tempfile::tempdir().expect("a folder");
        let model = write_model(folder.path(), &text);
        let found = run_json(&["trim", &model]);
        for (name, right) in [("x_0", 0.0), ("y_0", -3.0), ("x_1", 0.0), ("y_1", -3.3)] {
            let value = found["at"][name].as_f64().expect("a number");
            assert!((value - right).abs() < 1e-9, "{light} kg: {name} = {value}");
        }
    }
}

#[test]
fn small_motions_at_an_equilibrium_with_rounding_satisfy_the_constraint() {
    let text = r#"
[model]
name = "bob"
[parameters]
g = { value = 9.81, unit = "m/s^2" }
m = { value = 1, unit = "kg" }
l = { value = 1, unit = "m" }
k = { value = 20, unit = "N/m" }
[coordinates]
x = { unit = "m", initial = "0.1*l" }
y = { unit = "m", initial = "0.1*l" }
z = { unit = "m", initial = "-l" }
[kinetic]
bob = "1/2*m*(dot(x)^2 + dot(y)^2 + dot(z)^2)"
[potential]
weight = "m*g*z"
spring = "1/2*k*((x - 0.2*l)^2 + y^2)"
[constraints]
sphere = { zero = "x^2 + y^2 + z^2 - l^2" }
"#;
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), text);
    for state in [
        &["--state", "trim"][..],
        &[
            "--state", "x=0.6", "--state", "y=1e-17", "--state", "z=-0.8",
        ],
    ] {
        let document = run_json(&[&["linearise", &model], state].concat());
        let at = |name: &str| document["at"][name].as_f64().expect("a number");
        let gradient = [at("x"), at("y"), at("z")];
        let rows: Vec<Vec<f64>> = document["N"]
            .as_array()
            .expect("rows")
            .iter()
            .map(numbers)
            .collect();
        assert_eq!(rows[0].len(), 4, "{state:?}");
        for block in [&rows[..3], &rows[3..]] {
            for column in 0..4 {
                let along = gradient
                    .iter()
                    .zip(block)
                    .map(|(entry, row)| entry * row[column]);
                assert!(
                    along.sum::<f64>().abs() < 1e-12,
                    "{state:?}: column {column}"
                );
            }
        }
    }
}
