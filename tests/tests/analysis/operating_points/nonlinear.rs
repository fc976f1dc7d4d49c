//! Comparison of linearisations with closed forms: norms of vectors at zero, and powers of a field.

use std::f64::consts::{PI, TAU};

use serde_json::Value;

use super::{run_json, write_model};

/// Returns a mass in space with drag against its velocity and a spring force along its position vector.
fn mass_in_space(drag: &str, spring: &str) -> String {
    format!(
        r#"
[model]
name = "mass"
[parameters]
m = {{ value = 2, unit = "kg", min = 0 }}
c = {{ value = 0.2, unit = "kg/m" }}
k = {{ value = 10, unit = "N/m" }}
l = {{ value = 0.5, unit = "m", min = 0 }}
s = {{ value = 1, unit = "m/s" }}
[coordinates]
x = {{ unit = "m" }}
y = {{ unit = "m" }}
z = {{ unit = "m" }}
[definitions]
r = "[x, y, z]"
v = "dot(r)"
[kinetic]
mass = "1/2*m*dot(v, v)"
[forces]
drag = {{ on = "r", value = "{drag}" }}
spring = {{ on = "r", value = "{spring}" }}
"#
    )
}

/// Returns the derivatives of the accelerations by positions and by velocities.
fn derivatives(model: &str, state: &[&str]) -> [[[f64; 3]; 3]; 2] {
    let given: Vec<&str> = state.iter().flat_map(|at| ["--state", at]).collect();
    let document = run_json(&[&["linearise", model], &given[..]].concat());
    let entry = |row: usize, column: usize| {
        let entry: &Value = &document["A"][3 + row][column];
        entry.as_f64().expect("a number")
    };
    [0, 3].map(|first| [0, 1, 2].map(|row| [0, 1, 2].map(|column| entry(row, first + column))))
}

/// Returns factor (|a| I + a a^T/|a|), the derivative of factor |a| a.
fn derivative_of_norm_times(factor: f64, a: [f64; 3]) -> [[f64; 3]; 3] {
    let norm = a.iter().map(|part| part * part).sum::<f64>().sqrt();
    let outer = |row: usize, column: usize| match norm > 0.0 {
        true => a[row] * a[column] / norm,
        false => 0.0,
    };
    let own = |row: usize, column: usize| if row == column { norm } else { 0.0 };
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| factor * (own(row, column) + outer(row, column))))
}

fn assert_close(found: [[f64; 3]; 3], right: [[f64; 3]; 3]) {
    for (found, right) in found.as_flattened().iter().zip(right.as_flattened()) {
        assert!((found - right).abs() < 1e-12, "{found:?} {right:?}");
    }
}

#[test]
fn quadratic_drag_is_linearised_at_rest_and_in_motion() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(
        folder.path(),
        &mass_in_space("-c*norm(v)*v", "-k*norm(r)/l*r"),
    );
    let states: [(&[&str], [f64; 3], [f64; 3]); 4] = [
        (&[], [0.0; 3], [0.0; 3]),
        (&["x_dot=3", "z_dot=-4"], [0.0; 3], [3.0, 0.0, -4.0]),
        (&["y=0.3", "z=0.4"], [0.0, 0.3, 0.4], [0.0; 3]),
        (&["x=1", "y_dot=1e-9"], [1.0, 0.0, 0.0], [0.0, 1e-9, 0.0]),
    ];
    for (state, position, velocity) in states {
        let [by_position, by_velocity] = derivatives(&model, state);
        assert_close(
            by_position,
            derivative_of_norm_times(-10.0 / 0.5 / 2.0, position),
        );
        assert_close(by_velocity, derivative_of_norm_times(-0.2 / 2.0, velocity));
    }
}

#[test]
fn powers_of_norms_have_zero_derivative_at_rest() {
    let folder = tempfile::tempdir().expect("a folder");
    for (drag, spring) in [
        ("-c*norm(v)^3/s^2*v", "-k*(norm(r)/l)^3*r"),
        ("-c*sqrt(norm(v)/s)*norm(v)*v", "-k*sqrt(norm(r)/l)*r"),
        ("-c*norm([dot(x), dot(y)])*v", "-k*norm([y, z])/l*r"),
    ] {
        let model = write_model(folder.path(), &mass_in_space(drag, spring));
        for part in derivatives(&model, &[]) {
            assert_close(part, [[0.0; 3]; 3]);
        }
    }
}

/// String on an elastic bed whose force is proportional to the cube of the deflection.
const STRING_ON_BED: &str = r#"
[model]
name = "string_on_bed"
[parameters]
mu = { value = 0.5, unit = "kg/m" }
H = { value = 8, unit = "N" }
a = { value = 30, unit = "N/m^4" }
l = { value = 2, unit = "m" }
[fields.w]
along = "x"
from = 0
to = "l"
basis = "string"
coordinates = "q"
order = 2
unit = "m"
[kinetic]
string = "1/2*integral(mu*dot(w)^2, w)"
[potential]
tension = "1/2*integral(H*diff(w, x)^2, w)"
bed = "1/4*integral(a*w^4, w)"
"#;

#[test]
fn quartic_bed_energy_raises_frequencies_with_the_deflection() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), STRING_ON_BED);
    let (mu, tension, a, length) = (0.5, 8.0, 30.0, 2.0);
    for deflection in [0.0, 0.3, -1.1] {
        let state = format!("q_1={deflection}");
        let found = run_json(&["modes", &model, "--state", &state, "--json"]);
        // For w = q sin(pi x/l), the bed adds (a/mu) 9/4 q^2 and (a/mu) 3/2 q^2 to the squares of the frequencies.
        let squares = [(1.0, 9.0 / 4.0), (2.0, 3.0 / 2.0)].map(|(waves, factor)| {
            let own: f64 = tension / mu * (waves * PI / length).powi(2);
            own + factor * a / mu * deflection * deflection
        });
        let mut right = squares.map(|square| square.sqrt() / TAU);
        right.sort_by(f64::total_cmp);
        let modes = found["modes"].as_array().expect("modes");
        assert_eq!(modes.len(), 2);
        for (mode, right) in modes.iter().zip(right) {
            let frequency = mode["frequency"].as_f64().expect("Hz");
            assert!(
                (frequency / right - 1.0).abs() < 1e-10,
                "{frequency} {right}"
            );
        }
    }
}
