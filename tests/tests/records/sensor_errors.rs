//! Tests of `compare` with a correct model and declared sensor errors: large biases, gains, and delays under inputs
//! that jump at each sample. The records are from a pendulum with a hardening spring, integrated with small steps.

use eomgen_tests::program::{Texts, run_on_texts};
use serde_json::Value;

const PENDULUM: &str = r#"
[model]
name = "pendulum"

[parameters]
J = { value = 0.5, unit = "kg m^2", min = 0 }
w = { value = 8, unit = "N m", min = 0 }
k = { value = 3, unit = "N m", min = 0 }
c = { value = 0.2, unit = "N m s", min = 0 }

[coordinates]
th = { unit = "rad" }

[inputs]
u = { unit = "N m" }

[kinetic]
arm = "1/2*J*dot(th)^2"

[potential]
weight = "-w*cos(th)"
spring = "1/4*k*th^4"

[dissipation]
bearing = "1/2*c*dot(th)^2"

[forces]
motor = { on = "th", value = "u" }
"#;

/// Time between samples, s.
const STEP: f64 = 0.04;

/// Number of samples of a record.
const SAMPLES: usize = 400;

/// Number of integration steps per sample.
const PARTS: usize = 32;

/// Standard deviations of the noise of the angle (rad) and of the rate (rad/s).
const NOISE: [f64; 2] = [1e-3, 4e-3];

/// Errors of a sensor of the angle or of the rate.
#[derive(Clone, Copy)]
struct Sensor {
    gain: f64,
    bias: f64,
    /// Delay, in integration steps.
    delay: i32,
}

const IDEAL: Sensor = Sensor {
    gain: 1.0,
    bias: 0.0,
    delay: 0,
};

/// Approximately normal numbers, each a sum of twelve uniform ones.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            sum += (self.0 >> 11) as f64 / (1_u64 << 53) as f64;
        }
        sum
    }
}

/// Returns the states at all integration steps, from two samples before the record to two samples after it, and the
/// held inputs of these samples.
fn motion(seed: u64) -> (Vec<[f64; 2]>, Vec<f64>) {
    let turn = seed as f64;
    let input = |sample: usize| {
        let t = STEP * sample as f64;
        4.0 * (3.1 * t + turn).sin() + 3.0 * (7.3 * t * (1.0 + 0.05 * turn)).sin()
    };
    let inputs: Vec<f64> = (0..SAMPLES + 4).map(input).collect();
    let (mut state, mut states) = ([0.3, 0.0], Vec::new());
    let h = STEP / PARTS as f64;
    for u in &inputs {
        let rates =
            |[th, v]: [f64; 2]| [v, (u - 0.2 * v - 8.0 * th.sin() - 3.0 * th.powi(3)) / 0.5];
        for _ in 0..PARTS {
            states.push(state);
            let along = |k: [f64; 2], part: f64| [0, 1].map(|i| state[i] + part * h * k[i]);
            let a = rates(state);
            let b = rates(along(a, 0.5));
            let c = rates(along(b, 0.5));
            let d = rates(along(c, 1.0));
            state = [0, 1].map(|i| state[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
    }
    (states, inputs)
}

/// Returns a record with the columns t, u, th, v.
fn record(sensors: [Sensor; 2], seed: u64) -> String {
    let (states, inputs) = motion(seed);
    let mut noise = Noise(seed + 11);
    let mut text = "t,u,th,v\n".to_owned();
    for (sample, input) in inputs.iter().enumerate().skip(2).take(SAMPLES) {
        let t = STEP * (sample - 2) as f64;
        text += &format!("{t:.4},{input:.15e}");
        for (place, sensor) in sensors.iter().enumerate() {
            let at = (sample * PARTS) as i32 - sensor.delay;
            let quantity = states[at as usize][place] + NOISE[place] * noise.next();
            text += &format!(",{:.15e}", sensor.gain * quantity + sensor.bias);
        }
        text.push('\n');
    }
    text
}

/// Channels of a comparison, with the text that declares the errors of the sensors.
#[derive(Clone, Copy)]
enum Channels<'t> {
    Angle(&'t str),
    AngleAndRate,
}

/// Compares the pendulum with records of these sensors. `start` is the source of the initial states.
fn compare(sensors: [Sensor; 2], channels: Channels<'_>, start: &str) -> Value {
    let declared = match channels {
        Channels::Angle(declared) => declared,
        Channels::AngleAndRate => "",
    };
    let mut dataset = format!(
        "[records]\ntrain = [\"train.csv\"]\ntest = [\"test.csv\"]\n\n[time]\ncolumn = \"t\"\nunit = \"s\"\n\n\
         [inputs.u]\ncolumn = \"u\"\nunit = \"N m\"\n\n[windows]\nlength = 2.0\nstart = \"{start}\"\n\n\
         [channels.th]\ncolumn = \"th\"\nunit = \"rad\"\nnoise = {}\n{declared}\n",
        sensors[0].gain.abs() * NOISE[0]
    );
    if matches!(channels, Channels::AngleAndRate) {
        dataset += &format!(
            "[channels.v]\ncolumn = \"v\"\nunit = \"rad/s\"\nobservable = \"dot(th)\"\nnoise = {}\n",
            sensors[1].gain.abs() * NOISE[1]
        );
    }
    let [train, test] = [1, 2].map(|seed| record(sensors, seed));
    run_on_texts(
        "compare",
        Texts {
            specification: PENDULUM,
            dataset: &dataset,
            train: &train,
            test: &test,
        },
    )
}

/// Asserts that residual and noise floor of a correct model are close to the noise of the sensors.
fn assert_no_gap(found: &Value, noises: &[(&str, f64)], case: &str) {
    assert_eq!(
        found["verdict"], "no_significant_gap",
        "{case}: {:#}",
        found["gap"]
    );
    for (channel, noise) in noises {
        for key in ["floor", "train", "test"] {
            let size = found["gap"][channel][key].as_f64().expect("a number") / noise;
            assert!(
                (0.8..1.3).contains(&size),
                "{case}: {channel} {key}: {size}"
            );
        }
    }
}

#[test]
fn declared_bias_and_gain_leave_the_noise_floor_unchanged() {
    for (gain, bias) in [
        (1.0, 0.0),
        (1.0, 20.0),
        (1.0, -62.83),
        (1.0, 300.0),
        (2.0, 100.0),
        (-1.0, 40.0),
        (1e-3, 5.0),
    ] {
        let sensor = Sensor {
            gain,
            bias,
            ..IDEAL
        };
        let noise = f64::abs(gain) * NOISE[0];
        let declared = format!(
            "gain = {{ mean = {gain}, sd = {} }}\nbias = {{ mean = {bias}, sd = {} }}\n",
            0.01 * f64::abs(gain),
            10.0 * noise
        );
        let found = compare([sensor, IDEAL], Channels::Angle(&declared), "fitted");
        assert_no_gap(
            &found,
            &[("th", noise)],
            &format!("gain {gain}, bias {bias}"),
        );
    }
}

#[test]
fn declared_bias_and_gain_leave_smoothed_initial_states_unchanged() {
    let mut ideal = None;
    for (gain, bias) in [(1.0, 0.0), (1.0, 62.83), (2.0, -7.0), (-0.5, 300.0)] {
        let sensor = Sensor {
            gain,
            bias,
            ..IDEAL
        };
        let declared =
            format!("gain = {{ mean = {gain}, sd = 0 }}\nbias = {{ mean = {bias}, sd = 0 }}\n");
        let found = compare([sensor, IDEAL], Channels::Angle(&declared), "smoothed");
        let gap = |key: &str| found["gap"]["th"][key].as_f64().expect("a number");
        let sizes = ["floor", "train", "test"].map(|key| gap(key) / gain.abs());
        let ideal = *ideal.get_or_insert(sizes);
        for (size, right) in sizes.iter().zip(ideal) {
            assert!(
                (size / right - 1.0).abs() < 1e-3,
                "{gain}, {bias}: {sizes:?}, {ideal:?}"
            );
        }
    }
}

#[test]
fn delayed_sensors_under_held_inputs_leave_no_gap() {
    for parts in [0, 16, -16, 24, 40] {
        let late = Sensor {
            delay: parts,
            ..IDEAL
        };
        let noises = [("th", NOISE[0]), ("v", NOISE[1])];
        let found = compare([late, late], Channels::AngleAndRate, "fitted");
        assert_no_gap(&found, &noises, &format!("{parts} of {PARTS} parts late"));
        let delay = found["sensors"]["v"]["delay"].as_f64().expect("a number");
        let right = STEP * f64::from(parts) / PARTS as f64;
        assert!(
            (delay - right).abs() < 0.02 * STEP,
            "{delay} instead of {right}"
        );
    }
}
