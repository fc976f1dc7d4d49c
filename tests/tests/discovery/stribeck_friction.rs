//! Test of Stribeck friction on a stage that often stops. The friction decreases only above a third of the typical
//! speed. The effect is found with its parameter values. The records are from set-valued time stepping that shares no
//! code with the simulator.

use std::f64::consts::TAU;

use eomgen_tests::logistic_noise::LogisticNoise;
use eomgen_tests::program;

const M: f64 = 3.5;
const C: f64 = 19.0;
const K: f64 = 200.0;
const T_S: f64 = 5.0;
const V_S: f64 = 0.15;

/// Standard deviation of the encoder, m.
const NOISE: f64 = 1e-5;

/// Time between samples, s.
const SAMPLE: f64 = 0.01;

const SPECIFICATION: &str = r#"
[model]
name = "stage"
[parameters]
m = { value = 3.5, unit = "kg" }
c = { value = 19, unit = "N s/m" }
k = { value = 200, unit = "N/m" }
[coordinates]
x = { unit = "m" }
[inputs]
F = { unit = "N" }
[kinetic]
table = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[dissipation]
guide = "1/2*c*dot(x)^2"
[forces]
motor = { on = "x", value = "F" }
"#;

const DATASET: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]
[time]
column = "t"
unit = "s"
[inputs.F]
column = "F"
unit = "N"
[channels.x]
column = "x"
unit = "m"
noise = 1e-5
[initial]
state = "rest"
[uncertain]
c = { relative = 0.1 }
[windows]
length = 0.6
"#;

/// Returns a record from rest under a sum of sines. In each short step, the friction impulse brings the speed as close
/// to zero as the friction level permits.
fn record(turn: f64) -> String {
    let parts = 2000;
    let h = SAMPLE / f64::from(parts);
    let (mut x, mut v) = (0.0, 0.0_f64);
    let mut noise = LogisticNoise::new(NOISE, 0.3 + 0.1 * turn);
    let mut text = "t,F,x\n".to_owned();
    for sample in 0..360 {
        let t = SAMPLE * f64::from(sample);
        let wave = |number: u32| {
            let frequency = 0.2 * 1.65_f64.powi(number as i32);
            (TAU * frequency * t + 2.3 * f64::from(number * number) + turn).sin()
        };
        let force = 12.0 * (0..7).map(wave).sum::<f64>();
        text += &format!("{t:.2},{force:.12},{:.9}\n", x + noise.draw());
        for _ in 0..parts {
            let middle = x + 0.5 * h * v;
            let free = v + h * (force - K * middle - C * v) / M;
            let most = h * T_S * (-(v / V_S).powi(2)).exp() / M;
            let next = free - free.clamp(-most, most);
            x += 0.5 * h * (v + next);
            v = next;
        }
    }
    text
}

#[test]
fn slowly_decreasing_stribeck_friction_is_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    for (name, text) in [
        ("stage.toml", SPECIFICATION),
        ("dataset.toml", DATASET),
        ("train.csv", &record(0.0)),
        ("test.csv", &record(1.0)),
    ] {
        std::fs::write(place(name), text).expect("a file");
    }
    let paths = ["stage.toml", "dataset.toml", "found"].map(place);
    let found = program::run_on_dataset("discover", paths.each_ref());
    let effects = found["effects"].as_array().expect("effects");
    assert_eq!(effects.len(), 1, "{found:#}");
    let effect = &effects[0];
    let place = ["effect", "on", "status"].map(|key| effect[key].as_str().unwrap_or_default());
    assert_eq!(place, ["stribeck_friction", "x", "named"], "{effect:#}");
    for (name, right) in [("T_s", T_S), ("v_s", V_S)] {
        let of = &effect["parameters"][name];
        let [value, sd] = ["value", "sd"].map(|key| of[key].as_f64().expect("a number"));
        assert!((value / right - 1.0).abs() < 0.02, "{name}: {value}");
        assert!((value - right).abs() < 4.0 * sd, "{name}: {value} {sd}");
    }
}
