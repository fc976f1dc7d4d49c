//! Tests of a motor with measured current and angle: the channel of the current is a first-order state. Windows start
//! from fitted or from measured states.

use eomgen_tests::logistic_noise::LogisticNoise;
use eomgen_tests::program::{self, Texts};
use serde_json::Value;

const MOTOR: &str = r#"
[model]
name = "motor"

[parameters]
J   = { value = 1e-4, unit = "kg m^2",  min = 0 }
c   = { value = 2e-4, unit = "N m s",   min = 0 }
K   = { value = 0.05, unit = "N m/A" }
R   = { value = 1.2,  unit = "ohm",     min = 0 }
L   = { value = 4,    unit = "mH",      min = 0 }

[coordinates]
theta = { unit = "rad" }

[inputs]
u = { unit = "V" }

[states]
i = { unit = "A", rate = "(u - R*i - K*dot(theta))/L" }

[kinetic]
rotor = "1/2*J*dot(theta)^2"

[dissipation]
bearing = "1/2*c*dot(theta)^2"

[forces]
coil = { on = "theta", value = "K*i" }
"#;

const DATASET: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]

[time]
column = "t"
unit = "s"

[inputs.u]
column = "u"
unit = "V"

[channels.theta]
column = "theta"
unit = "rad"
noise = 1e-3

[channels.i]
column = "i"
unit = "mA"
noise = 5

[initial]
state = "rest"

[uncertain]
c = { relative = 0.1 }

[windows]
length = 0.2
"#;

/// Returns a record of the motor with this resistance, ohm, and drag, N m s^2.
fn record(resistance: f64, drag: f64, turn: f64) -> String {
    let (j, c, k, l) = (1e-4, 2e-4, 0.05, 4e-3);
    let parts = 100;
    let h = 0.001 / f64::from(parts);
    let (mut angle, mut rate, mut current) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut noise = LogisticNoise::new(1.0, 0.3 + 0.1 * turn);
    let mut text = "t,u,theta,i\n".to_owned();
    for sample in 0..1000 {
        let t = 0.001 * f64::from(sample);
        let u = 3.0 * (19.0 * t + turn).cos() - 2.0 * (67.0 * t * (1.0 + 0.1 * turn)).sin();
        let seen = [
            angle + 1e-3 * noise.draw(),
            1e3 * current + 5.0 * noise.draw(),
        ];
        text += &format!("{t:.3},{u:.12},{:.9},{:.9}\n", seen[0], seen[1]);
        let slopes = |rate: f64, current: f64| {
            (
                (k * current - c * rate - drag * rate * rate.abs()) / j,
                (u - resistance * current - k * rate) / l,
            )
        };
        for _ in 0..parts {
            let (a, b) = slopes(rate, current);
            let (middle, half) = (rate + 0.5 * h * a, current + 0.5 * h * b);
            let (a, b) = slopes(middle, half);
            angle += h * middle;
            (rate, current) = (rate + h * a, current + h * b);
        }
    }
    text
}

fn run_on_records(command: &str, (resistance, drag): (f64, f64), dataset: &str) -> Value {
    let texts = Texts {
        specification: MOTOR,
        dataset,
        train: &record(resistance, drag, 0.0),
        test: &record(resistance, drag, 1.0),
    };
    program::run_on_texts(command, texts)
}

#[test]
fn wrong_resistance_is_found_from_measured_current() {
    let found = run_on_records("discover", (1.38, 0.0), DATASET);
    let effects = found["effects"].as_array().expect("a list");
    assert_eq!(effects.len(), 1, "{effects:#?}");
    assert_eq!(effects[0]["effect"], "parameter_shift", "{effects:#?}");
    assert_eq!(effects[0]["on"], "R", "{effects:#?}");
    let value = effects[0]["parameters"]["R"]["value"].as_f64();
    assert!(
        value.is_some_and(|value| (value - 1.38).abs() < 0.01),
        "{value:?}"
    );
}

/// Effects on coordinates are also found in models with first-order states.
#[test]
fn drag_on_shaft_is_found_with_measured_current() {
    let found = run_on_records("discover", (1.2, 2e-5), DATASET);
    let effects = found["effects"].as_array().expect("a list");
    assert_eq!(effects.len(), 1, "{effects:#?}");
    assert_eq!(effects[0]["effect"], "quadratic_drag", "{effects:#?}");
    assert_eq!(effects[0]["on"], "theta", "{effects:#?}");
    let value = effects[0]["parameters"]["c_2"]["value"].as_f64();
    assert!(
        value.is_some_and(|value| (value - 2e-5).abs() < 1e-6),
        "{value:?}"
    );
}

#[test]
fn windows_start_from_measured_current() {
    let smoothed = DATASET.replace("length = 0.2", "length = 0.2\nstart = \"smoothed\"");
    let found = run_on_records("compare", (1.2, 0.0), &smoothed);
    assert_eq!(found["gap"]["i"]["unit"], "A", "{found:#}");
    // Measured initial states are not fitted to the window. Therefore the residual exceeds the noise, but it remains
    // far below the current.
    let left = found["gap"]["i"]["train"].as_f64();
    assert!(
        left.is_some_and(|left| (4e-3..0.05).contains(&left)),
        "{left:?}"
    );
}
