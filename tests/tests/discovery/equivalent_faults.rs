//! Test that inseparable faults of a linear model form classes, and that sizes that depend on the choice of a member have
//! standard deviations that contain these sizes.

use eomgen_tests::program;
use serde_json::Value;

const OSCILLATOR: &str = r#"
[model]
name = "oscillator"
[parameters]
m = { value = 1.3, unit = "kg" }
k = { value = 210, unit = "N/m" }
c = { value = 1.1, unit = "N s/m" }
[coordinates]
x = { unit = "m" }
[inputs]
F = { unit = "N" }
[kinetic]
body = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[dissipation]
damper = "1/2*c*dot(x)^2"
[forces]
drive = { on = "x", value = "F" }
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
noise = 2e-4
[windows]
length = 1.0
"#;

/// Standard deviation of uniform noise, m.
const NOISE: f64 = 2e-4;

/// Faults of a record.
#[derive(Clone, Copy)]
struct Faults {
    /// True force relative to the recorded force.
    gain: f64,
    /// Offset of the sensor, m.
    offset: f64,
    /// Time constant of a low-pass in the sensor, s; 0 for none.
    lag: f64,
}

/// A record without a fault.
const NONE: Faults = Faults {
    gain: 1.0,
    offset: 0.0,
    lag: 0.0,
};

/// Returns a record of the oscillator with these faults and this number of samples.
fn record(faults: Faults, shift: f64, samples: u32) -> String {
    let Faults { gain, offset, lag } = faults;
    let (m, k, c) = (1.3, 210.0, 1.1);
    let force = |t: f64| {
        4.0 * (3.1 * t + shift).sin() + 3.0 * (7.3 * t - shift).sin() + 2.0 * (15.7 * t).cos()
    };
    let (mut x, mut v, mut filtered, mut noise) = (0.0, 0.0, 0.0, 0.31 + 0.1 * shift);
    let mut text = "t,F,x\n".to_owned();
    for sample in 0..samples {
        let t = 0.01 * f64::from(sample);
        noise = 4.0 * noise * (1.0 - noise) * 0.999_999;
        let sensed: f64 = if lag > 0.0 { filtered } else { x };
        let shown = sensed + offset + NOISE * 2.8 * (noise - 0.5);
        text += &format!("{t:.2},{:.9},{shown:.9}\n", force(t));
        // Velocity Verlet method; the force is interpolated between samples as in `discover`.
        let steps = 200;
        let h = 0.01 / f64::from(steps);
        for step in 0..steps {
            let part = |s: f64| {
                let s = s / f64::from(steps);
                gain * ((1.0 - s) * force(t) + s * force(t + 0.01))
            };
            let acceleration = |x: f64, v: f64, s: f64| (part(s) - c * v - k * x) / m;
            let s = f64::from(step);
            let middle = v + 0.5 * h * acceleration(x, v, s);
            let between = x + 0.5 * h * v;
            if lag > 0.0 {
                filtered = between + (filtered - between) * (-h / lag).exp();
            }
            x += h * middle;
            v += h * acceleration(between, middle, s + 0.5);
        }
    }
    text
}

/// Runs `discover` on records with these faults and returns the document.
fn answer(faults: Faults) -> Value {
    answer_with(faults, 800, OSCILLATOR, DATASET)
}

/// Runs `discover` on records with this number of samples, with this specification and dataset file.
fn answer_with(faults: Faults, samples: u32, specification: &str, dataset: &str) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name);
    for (name, text) in [
        ("oscillator.toml", specification.to_owned()),
        ("dataset.toml", dataset.to_owned()),
        ("train.csv", record(faults, 0.0, samples)),
        ("test.csv", record(faults, 1.0, samples)),
    ] {
        std::fs::write(file(name), text).expect("a file");
    }
    let paths = ["oscillator.toml", "dataset.toml", "out"].map(file);
    program::run_on_dataset("discover", paths.each_ref())
}

/// Returns the names of the effects in the class; the first is the reported effect.
fn find_class(gain: f64, offset: f64) -> Vec<String> {
    let document = answer(Faults {
        gain,
        offset,
        ..NONE
    });
    let effects = document["effects"].as_array().expect("effects");
    assert_eq!(effects.len(), 1, "{document:#}");
    assert_eq!(effects[0]["status"], "class", "{document:#}");
    let others = effects[0]["equivalent"].as_array().expect("a list");
    let named = |of: &Value| format!("{} on {}", of["effect"], of["on"]).replace('"', "");
    let mut names: Vec<String> = std::iter::once(&effects[0])
        .chain(others)
        .map(named)
        .collect();
    names.sort();
    names
}

#[test]
fn gains_of_a_sensor_and_of_an_input_form_a_class() {
    for gain in [1.15, 0.85] {
        assert_eq!(
            find_class(gain, 0.0),
            ["input_gain on F", "sensor_gain on x"],
            "{gain}"
        );
    }
}

#[test]
fn offsets_of_a_sensor_and_of_a_force_form_a_class() {
    for offset in [0.02, -0.015] {
        let expected = ["force_offset on x", "input_bias on F", "sensor_bias on x"];
        assert_eq!(find_class(1.0, offset), expected, "{offset}");
    }
}

/// With a wrong mass, a wrong stiffness and uncertain damping, the mass is known only up to the gain.
#[test]
fn size_that_depends_on_a_class_has_a_wide_interval() {
    let specification = OSCILLATOR.replace("value = 1.3", "value = 1.5");
    let specification = specification.replace("value = 210", "value = 240");
    let dataset = format!("{DATASET}\n[uncertain]\nc = {{ relative = 0.5 }}\n");
    let document = answer_with(NONE, 300, &specification, &dataset);
    let effects = document["effects"].as_array().expect("effects");
    let gain = effects
        .iter()
        .find(|effect| effect["effect"] == "sensor_gain");
    let gain = gain.unwrap_or_else(|| panic!("no gain: {document:#}"));
    let number = |value: &Value| value.as_f64().expect("a number");
    let size = &gain["parameters"]["gain"];
    let sizes = gain["conditional"]
        .as_array()
        .expect("sizes that depend on the class");
    assert!(!sizes.is_empty(), "{document:#}");
    for of in sizes {
        let other = &of["parameters"]["gain"];
        let difference = (number(&other["value"]) - number(&size["value"])).abs();
        assert!(difference > 2.0 * number(&other["sd"]), "{of:#}");
        assert!(difference < 3.0 * number(&size["sd"]), "{of:#}");
    }
    for of in effects
        .iter()
        .flat_map(|effect| effect["equivalent"].as_array().expect("a list"))
    {
        let sizes = of["parameters"].as_object().expect("sizes");
        assert!(!sizes.is_empty(), "{of:#}");
    }
}

#[test]
fn lag_of_a_sensor_is_noted_with_lag_of_the_input() {
    let document = answer(Faults { lag: 0.03, ..NONE });
    assert_eq!(
        document["effects"][0]["effect"], "input_lag",
        "{document:#}"
    );
    let notes = document["notes"].to_string();
    assert!(
        notes.contains("the same low-pass in every sensor"),
        "{notes}"
    );
}
