//! Tests of a driven pendulum whose input differs from the recorded input. The difference is found as an effect if it
//! is not declared, and refitted if it is within declared uncertainties. The records are from Newton's law, integrated
//! with small steps.

use eomgen_tests::program;
use serde_json::Value;

const PENDULUM: &str = r#"
[model]
name = "driven_pendulum"

[parameters]
J = { value = 0.05, unit = "kg m^2", min = 0 }
c = { value = 0.04, unit = "N m s", min = 0 }
w = { value = 1.2, unit = "N m", min = 0, doc = "weight times its lever" }

[coordinates]
theta = { unit = "rad" }

[inputs]
u = { unit = "N m" }

[kinetic]
rotor = "1/2*J*dot(theta)^2"

[potential]
weight = "-w*cos(theta)"

[dissipation]
bearing = "1/2*c*dot(theta)^2"

[forces]
motor = { on = "theta", value = "u" }
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
unit = "mN m"

[channels.theta]
column = "theta"
unit = "rad"
noise = 1e-4

[initial]
state = "rest"

[windows]
length = 0.5
"#;

/// Drive torque gain * (u + bias) in N m. The input u is delayed by `delay` and low-pass filtered with the time
/// constant `lag`, both in s.
#[derive(Clone, Copy)]
struct Drive {
    gain: f64,
    bias: f64,
    delay: f64,
    lag: f64,
}

const IDEAL: Drive = Drive {
    gain: 1.0,
    bias: 0.0,
    delay: 0.0,
    lag: 0.0,
};

/// Returns a record with the torque gain * (u + bias), N m.
fn record(gain: f64, bias: f64, turn: f64) -> String {
    driven_record(
        Drive {
            gain,
            bias,
            ..IDEAL
        },
        turn,
    )
}

/// Returns a record of t, u in mN m, theta.
fn driven_record(drive: Drive, turn: f64) -> String {
    let Drive {
        gain,
        bias,
        delay,
        lag,
    } = drive;
    let (inertia, damping, weight) = (0.05, 0.04, 1.2);
    let (mut theta, mut rate, mut noise): (f64, f64, f64) = (0.0, 0.0, 0.3 + 0.1 * turn);
    let mut low_pass = 0.0;
    let mut text = "t,u,theta\n".to_owned();
    for sample in 0..800 {
        let t = 0.005 * f64::from(sample);
        let wave = |t: f64| {
            let t = t.max(0.0);
            0.9 * (4.1 * t + turn).sin() + 0.5 * (9.7 * t * (1.0 + 0.1 * turn)).sin()
        };
        let (u, told) = (wave(t), wave(t - delay));
        noise = 4.0 * noise * (1.0 - noise) * 0.999_999;
        let shown = theta + 1e-4 * 2.8 * (noise - 0.5);
        text += &format!("{t:.3},{:.15},{shown:.9}\n", 1e3 * u);
        for _ in 0..50 {
            let h = 1e-4;
            let before = low_pass;
            low_pass = told + (before - told) * (-h / lag).exp();
            let acting = match lag > 0.0 {
                true => 0.5 * (before + low_pass),
                false => told,
            };
            let acceleration = |theta: f64, rate: f64| {
                (gain * (acting + bias) - damping * rate - weight * theta.sin()) / inertia
            };
            let (half, slope) = (theta + 0.5 * h * rate, acceleration(theta, rate));
            let middle = rate + 0.5 * h * slope;
            theta += h * middle;
            rate += h * acceleration(half, middle);
        }
    }
    text
}

fn discover(dataset: &str, specification: &str, (gain, bias): (f64, f64)) -> (Value, String) {
    let records = [0.0, 1.0].map(|turn| record(gain, bias, turn));
    discover_in(dataset, specification, &records)
}

fn discover_in(dataset: &str, specification: &str, records: &[String; 2]) -> (Value, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name);
    for (name, text) in [
        ("pendulum.toml", specification),
        ("dataset.toml", dataset),
        ("train.csv", &records[0]),
        ("test.csv", &records[1]),
    ] {
        std::fs::write(file(name), text).expect("a file");
    }
    let paths = ["pendulum.toml", "dataset.toml", "out"].map(file);
    let document = program::run_on_dataset("discover", paths.each_ref());
    let extended = std::fs::read_to_string(file("out/extended.toml"));
    (document, extended.expect("a file"))
}

/// Returns the value of the only effect's parameter, and the names of the effect and its
/// equivalents.
fn only_effect(document: &Value) -> (f64, Vec<String>) {
    let effects = document["effects"].as_array().expect("effects");
    assert_eq!(effects.len(), 1, "{effects:#?}");
    let named = |of: &Value| format!("{} on {}", of["effect"], of["on"]).replace('"', "");
    let others = effects[0]["equivalent"].as_array().expect("a list");
    let names = std::iter::once(&effects[0]).chain(others).map(named);
    let parameters = effects[0]["parameters"].as_object();
    let value = parameters.and_then(|p| p.values().next());
    let value = value.and_then(|p| p["value"].as_f64()).expect("a value");
    (value, names.collect())
}

#[test]
fn low_torque_constant_is_found_as_input_gain() {
    let (document, extended) = discover(DATASET, PENDULUM, (0.9, 0.0));
    let (gain, names) = only_effect(&document);
    assert_eq!(names[0], "input_gain on u", "{names:?}");
    assert!((gain - 0.9).abs() < 2e-3, "{gain}");
    assert!(extended.contains("value = \"u_gain*u\""), "{extended}");
    // The extended specification explains the records.
    let (again, _) = discover(DATASET, &extended, (0.9, 0.0));
    assert_eq!(again["verdict"], "no_significant_gap", "{again:#}");
}

#[test]
fn constant_torque_is_reported_with_input_bias() {
    let (document, _) = discover(DATASET, PENDULUM, (1.0, 0.08));
    let (bias, names) = only_effect(&document);
    assert!((bias.abs() - 0.08).abs() < 2e-3, "{bias}");
    assert!(names.contains(&"input_bias on u".to_owned()), "{names:?}");
}

#[test]
fn declared_input_uncertainty_is_refitted_within_prior() {
    let said = |gain: &str| DATASET.replace("unit = \"mN m\"", &format!("unit = \"mN m\"\n{gain}"));
    let declared = said("gain = { sd = 0.02 }\nbias = { mean = 50, sd = 10 }");
    let (document, extended) = discover(&declared, PENDULUM, (0.97, 0.06));
    assert_eq!(document["verdict"], "no_significant_gap", "{document:#}");
    let fitted = |name: &str| {
        document["refitted"][name]["value"]
            .as_f64()
            .expect("a value")
    };
    assert!((fitted("u_gain") - 0.97).abs() < 2e-3, "{document:#}");
    assert!((fitted("u_bias") - 0.06).abs() < 2e-3, "{document:#}");
    assert!(extended.contains("u_gain*(u + u_bias)"), "{extended}");
    // The refit starts from the previous result, and no effect is added twice.
    let (again, extended) = discover(&declared, &extended, (0.97, 0.06));
    assert_eq!(again["verdict"], "no_significant_gap", "{again:#}");
    assert_eq!(extended.matches("u_gain*").count(), 1, "{extended}");
    // An existing parameter with the name of the gain is not used as the gain.
    let other = PENDULUM.replace(
        "[coordinates]",
        "u_gain = { value = 5, unit = \"1\" }\n\n[coordinates]",
    );
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name).display().to_string();
    for (name, text) in [("other.toml", &other), ("dataset.toml", &declared)] {
        std::fs::write(file(name), text).expect("a file");
    }
    for (name, turn) in [("train.csv", 0.0), ("test.csv", 1.0)] {
        std::fs::write(file(name), record(1.0, 0.0, turn)).expect("a file");
    }
    let (model, dataset, out) = (file("other.toml"), file("dataset.toml"), file("out"));
    let message = program::run_rejected(&["discover", &model, &dataset, "--out", &out]);
    assert!(message.contains("u_gain"), "{message}");
    // A deviation above three standard deviations of the prior is an effect.
    let (document, _) = discover(&said("gain = { sd = 0.01 }"), PENDULUM, (0.9, 0.0));
    let (gain, names) = only_effect(&document);
    assert_eq!(names[0], "input_gain on u", "{names:?}");
    assert!((gain - 0.9).abs() < 2e-3, "{gain}");
}

#[test]
fn input_delay_is_found_as_a_single_effect() {
    let lever = "\n[observables]\nlever = { value = \"0.3*sin(theta)\" }\n"
        .replace(" }", ", unit = \"rad\" }");
    let specification = format!("{PENDULUM}{lever}");
    let second = "[channels.lever]\ncolumn = \"lever\"\nunit = \"rad\"\nnoise = 1e-4\n\n[initial]";
    let dataset = |delay: &str| {
        DATASET
            .replace("[initial]", second)
            .replace("unit = \"mN m\"", &format!("unit = \"mN m\"\n{delay}"))
    };
    // In the first four samples the pendulum is at rest.
    let records = [0.0, 1.0].map(|turn| {
        let lines = driven_record(
            Drive {
                delay: 0.02,
                ..IDEAL
            },
            turn,
        );
        let with_lever = |line: &str| {
            let theta = line
                .rsplit(',')
                .next()
                .and_then(|theta| theta.parse::<f64>().ok());
            match theta {
                Some(theta) => format!("{line},{:.9}\n", 0.3 * theta.sin()),
                None => format!("{line},lever\n"),
            }
        };
        lines.lines().map(with_lever).collect::<String>()
    });
    let declared = dataset("delay = { sd = 0.0025 }");
    let (document, extended) = discover_in(&declared, &specification, &records);
    let (delay, names) = only_effect(&document);
    assert_eq!(names[0], "input_delay on u", "{names:?}");
    assert!((delay - 0.02).abs() < 2e-4, "{delay}");
    let (again, _) = discover_in(&declared, &extended, &records);
    assert_eq!(again["verdict"], "no_significant_gap", "{again:#}");
    let known = dataset("delay = { mean = 0.02, sd = 0 }");
    let (document, _) = discover_in(&known, &specification, &records);
    assert_eq!(document["verdict"], "no_significant_gap", "{document:#}");
}

#[test]
fn lag_of_drive_is_found() {
    let drive = Drive { lag: 0.02, ..IDEAL };
    let records = [0.0, 1.0].map(|turn| driven_record(drive, turn));
    let (document, extended) = discover_in(DATASET, PENDULUM, &records);
    let (bandwidth, names) = only_effect(&document);
    assert_eq!(names, ["input_lag on u"], "{document:#}");
    assert!((bandwidth - 50.0).abs() < 1.0, "{bandwidth}");
    assert!(
        extended.contains("rate = \"w_b*(u - acting)\""),
        "{extended}"
    );
    let (again, _) = discover_in(DATASET, &extended, &records);
    assert_eq!(again["verdict"], "no_significant_gap", "{again:#}");
}
