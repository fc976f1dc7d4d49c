//! Test of two effects in swings of a pendulum, one of them periodic in the angle. Neither effect is significant
//! without the other; both are named.

use eomgen_tests::models::path;
use eomgen_tests::program;

/// Resolution of the angle encoder, rad.
const STEP_OF_ENCODER: f64 = 1e-3;

const DESCRIPTION: &str = r#"
[records]
train = ["1.4.csv", "2.6.csv"]
test = ["4.0.csv"]

[time]
column = "t"
unit = "s"

[channels.theta]
column = "theta"
unit = "rad"
noise = 3e-4

[initial]
state = "estimate"

[uncertain]
k = { relative = 0.3 }

[windows]
length = "record"
start = "fitted"
"#;

/// Returns the torque of the hidden effects, N m, at an angle and a rate.
fn hidden_torque(theta: f64, rate: f64) -> f64 {
    let friction = 6e-4 * (rate / 0.02).tanh();
    let ripple = 1.5e-3 * (2.0 * theta + 0.4).cos();
    ripple - friction
}

/// Returns the angular acceleration, rad/s^2, of the arm of `pendulum.toml`.
fn acceleration(theta: f64, rate: f64) -> f64 {
    let (m, a, inertia, k, g) = (0.14758, 0.14775, 1.091e-4, 2.239e-4, 9.81);
    (m * g * a * theta.sin() - k * rate + hidden_torque(theta, rate)) / (m * a * a + inertia)
}

/// Returns a record of a swing that starts at rest at an angle, by the midpoint rule with steps of 20 us.
fn swing(from: f64) -> String {
    let (samples, parts, sample) = (700, 100, 0.002);
    let h = sample / f64::from(parts);
    let (mut theta, mut rate) = (from, 0.0);
    let mut text = "t,theta\n".to_owned();
    for number in 0..samples {
        let seen = (theta / STEP_OF_ENCODER).round() * STEP_OF_ENCODER;
        text += &format!("{:.6},{seen:.4}\n", f64::from(number) * sample);
        for _ in 0..parts {
            let middle = (
                theta + 0.5 * h * rate,
                rate + 0.5 * h * acceleration(theta, rate),
            );
            theta += h * middle.1;
            rate += h * acceleration(middle.0, middle.1);
        }
    }
    text
}

#[test]
fn friction_and_ripple_significant_only_together_are_both_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    std::fs::write(place("dataset.toml"), DESCRIPTION).expect("a file");
    for from in [1.4, 2.6, 4.0] {
        std::fs::write(place(&format!("{from:.1}.csv")), swing(from)).expect("a file");
    }
    let paths = [path("pendulum"), place("dataset.toml"), place("found")];
    let found = program::run_on_dataset("discover", paths.each_ref());
    let effects = found["effects"].as_array().expect("a list");
    let mut names: Vec<&str> = effects
        .iter()
        .filter_map(|e| e["effect"].as_str())
        .collect();
    names.sort_unstable();
    assert_eq!(names, ["coulomb_friction", "torque_ripple"], "{effects:#?}");
    let ripple = effects.iter().find(|e| e["effect"] == "torque_ripple");
    assert_eq!(
        ripple.expect("a ripple")["order"]["order"],
        2,
        "{ripple:#?}"
    );
    // With both effects, the residual must reach the noise and the encoder's resolution.
    let closure = found["closure"]["test"].as_f64().expect("a number");
    assert!(closure > 0.95, "{closure}");
}
