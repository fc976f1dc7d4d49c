//! Tests of backlash in the shaft of a drive of two masses. Backlash is the only effect found, whether the damper
//! parallel to the shaft's spring acts only in contact or also inside the backlash. No damping is reported as shifted.
//! If the model already has backlash, an offset of the backlash is found. A softer shaft has two names. The records are
//! from Newton's laws, integrated with the midpoint rule.

use eomgen_tests::logistic_noise::LogisticNoise;
use eomgen_tests::program;
use serde_json::Value;

const J_M: f64 = 1e-3;
const J_L: f64 = 3e-3;
const K: f64 = 12.0;
const D: f64 = 8e-3;
const B_M: f64 = 6e-4;
const B_L: f64 = 5e-4;

/// Half of the backlash in rad, sixty times the encoders' noise.
const PLAY: f64 = 9e-3;

/// Standard deviation of an encoder, rad.
const NOISE: f64 = 1.5e-4;

/// Time between samples, in s.
const SAMPLE: f64 = 1e-3;
const SAMPLES: usize = 1500;

/// Returns a specification without backlash; `damper` is the text of the damper with its section.
fn specification(damper: &str) -> String {
    format!(
        r#"
[model]
name = "drive"

[parameters]
J_m = {{ value = 1e-3, unit = "kg m^2", min = 0 }}
J_l = {{ value = 3e-3, unit = "kg m^2", min = 0 }}
k = {{ value = 12, unit = "N m/rad", min = 0 }}
d = {{ value = 8e-3, unit = "N m s/rad", min = 0 }}
b_m = {{ value = 6e-4, unit = "N m s/rad", min = 0 }}
b_l = {{ value = 5e-4, unit = "N m s/rad", min = 0 }}

[coordinates]
theta_m = {{ unit = "rad" }}
theta_l = {{ unit = "rad" }}

[inputs]
u = {{ unit = "N m" }}

[definitions]
twist = "theta_m - theta_l"

[kinetic]
both = "1/2*J_m*dot(theta_m)^2 + 1/2*J_l*dot(theta_l)^2"

[potential]
shaft = "1/2*k*twist^2"

[dissipation]
motor = "1/2*b_m*dot(theta_m)^2"
load = "1/2*b_l*dot(theta_l)^2"
{damper}
drive = {{ on = "theta_m", value = "u" }}
"#
    )
}

/// Damper as a term of the dissipation.
const AS_DISSIPATION: &str = "shaft = \"1/2*d*(dot(theta_m) - dot(theta_l))^2\"\n[forces]";
const AS_FORCE: &str = "[forces]\ndamper = { on = \"twist\", value = \"-d*dot(twist)\" }";

const DATASET: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]

[time]
column = "t"
unit = "s"

[inputs.u]
column = "u"
unit = "N m"
hold = "zero-order"

[channels.theta_m]
column = "theta_m"
unit = "rad"
noise = 1.5e-4

[channels.theta_l]
column = "theta_l"
unit = "rad"
noise = 1.5e-4

[initial]
state = "rest"

[uncertain]
J_l = { relative = 0.03 }
b_m = { relative = 0.1 }

[windows]
length = 0.25
"#;

/// Torque of the shaft as a function of deflection and rate.
type Shaft = fn(f64, f64) -> f64;

fn deadzone(p: f64) -> f64 {
    p - p.clamp(-PLAY, PLAY)
}

/// Returns a record; `turn` changes the input.
fn record(shaft: Shaft, turn: f64) -> String {
    let parts = 50;
    let h = SAMPLE / f64::from(parts);
    let mut state = [0.0_f64; 4];
    let mut noise = LogisticNoise::new(NOISE, 0.4);
    let mut text = "t,u,theta_m,theta_l\n".to_owned();
    for sample in 0..SAMPLES {
        let t = SAMPLE * sample as f64;
        let u = 0.05 * (7.0 * t + turn).sin()
            + 0.04 * (23.0 * t * (1.0 + 0.2 * turn)).cos()
            + 0.03 * (61.0 * t + 2.0 * turn).sin();
        let [m, l] = [state[0] + noise.draw(), state[1] + noise.draw()];
        text += &format!("{t:.4},{u:.12},{m:.12},{l:.12}\n");
        let rates = |[m, l, v, w]: [f64; 4]| {
            let torque = shaft(m - l, v - w);
            [v, w, (u - torque - B_M * v) / J_M, (torque - B_L * w) / J_L]
        };
        let moved = |from: [f64; 4], by: f64, rates: [f64; 4]| -> [f64; 4] {
            std::array::from_fn(|i| from[i] + by * rates[i])
        };
        for _ in 0..parts {
            let middle = moved(state, 0.5 * h, rates(state));
            state = moved(state, h, rates(middle));
        }
    }
    text
}

fn answer(specification: &str, shaft: Shaft) -> (Value, String) {
    answer_of(specification, DATASET, shaft)
}

fn answer_of(specification: &str, dataset: &str, shaft: Shaft) -> (Value, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    let files = [
        ("spec.toml", specification.to_owned()),
        ("dataset.toml", dataset.to_owned()),
        ("train.csv", record(shaft, 0.0)),
        ("test.csv", record(shaft, 1.0)),
    ];
    for (name, text) in files {
        std::fs::write(place(name), text).expect("a file");
    }
    let paths = ["spec.toml", "dataset.toml", "found"].map(place);
    let found = program::run_on_dataset("discover", paths.each_ref());
    let extended = std::fs::read_to_string(place("found/extended.toml"));
    (found, extended.expect("a file"))
}

/// Asserts that backlash is the only effect and closes the gap, and that the extended specification reproduces the fit.
/// Returns the extended specification.
fn assert_only_play(specification: &str, shaft: Shaft) -> String {
    let (found, extended) = answer(specification, shaft);
    let effects = found["effects"].as_array().expect("a list");
    assert_eq!(effects.len(), 1, "{effects:#?}");
    let play = &effects[0];
    assert_eq!(play["effect"], "backlash", "{play:#}");
    assert_eq!(play["on"], "shaft", "{play:#}");
    assert_eq!(play["status"], "named", "{play:#}");
    let half = play["parameters"]["b_0"]["value"].as_f64();
    let half = half.unwrap_or_else(|| panic!("no b_0: {play:#}"));
    assert!((half - PLAY).abs() < 0.01 * PLAY, "{half}");
    let closure = found["closure"]["test"].as_f64();
    assert!(closure.is_some_and(|part| part > 0.99), "{closure:?}");
    assert_eq!(
        found["validation"]["passed"], true,
        "{}",
        found["validation"]
    );
    extended
}

fn contact_torque(p: f64, rate: f64) -> f64 {
    let damping = if deadzone(p) == 0.0 { 0.0 } else { D * rate };
    K * deadzone(p) + damping
}

#[test]
fn play_with_damper_in_contact_only_is_found() {
    for damper in [AS_DISSIPATION, AS_FORCE] {
        let extended = assert_only_play(&specification(damper), contact_torque);
        assert!(extended.contains("*contact(twist, b_0)"), "{extended}");
    }
}

#[test]
fn play_with_separate_damper_is_found() {
    let extended = assert_only_play(&specification(AS_DISSIPATION), |p, rate| {
        K * deadzone(p) + D * rate
    });
    assert!(!extended.contains("contact("), "{extended}");
}

#[test]
fn shaft_without_play_gives_no_effect() {
    let (found, _) = answer(&specification(AS_DISSIPATION), |p, rate| K * p + D * rate);
    assert_eq!(found["verdict"], "no_significant_gap", "{found:#}");
    assert_eq!(found["effects"].as_array().map(Vec::len), Some(0));
}

fn class_names(effect: &Value) -> Vec<String> {
    let name = |of: &Value| format!("{} {}", of["effect"], of["on"]).replace('"', "");
    let others = effect["equivalent"].as_array().into_iter().flatten();
    std::iter::once(effect).chain(others).map(name).collect()
}

#[test]
fn softer_shaft_is_stiffness_shift_or_joint_compliance() {
    let (found, _) = answer(&specification(AS_DISSIPATION), |p, rate| {
        0.8 * K * p + D * rate
    });
    let effects = found["effects"].as_array().expect("a list");
    assert_eq!(effects.len(), 1, "{effects:#?}");
    let names = class_names(&effects[0]);
    assert_eq!(
        names,
        ["parameter_shift k", "joint_compliance shaft"],
        "{found:#}"
    );
}

/// Centre of an offset backlash in rad: three half-widths from the centre in the model.
const CENTRE: f64 = 3.0 * PLAY;

#[test]
fn offset_play_is_found_in_rotating_mesh() {
    let play = "b = { value = 9e-3, unit = \"rad\", min = 0 }\n[coordinates]";
    let damper = "damper = \"1/2*d*dot(twist)^2*contact(twist, b)\"\n[forces]";
    let of_two_angles = specification(damper)
        .replace("k*twist^2", "k*deadzone(twist, b)^2")
        .replace("[coordinates]", play)
        + "[observables]\nmotor = { value = \"theta_m\", unit = \"rad\" }\n";
    let of_a_deflection = of_two_angles
        .replace("theta_m = {", "p = {")
        .replace("twist = \"theta_m - theta_l\"", "theta_m = \"theta_l + p\"")
        .replace("dot(twist)", "dot(p)")
        .replace("(twist, b)", "(p, b)");
    // The encoders have small bias priors. Otherwise a bias would be named first.
    let dataset = DATASET
        .replace("[channels.theta_m]", "[channels.motor]")
        .replace("state = \"rest\"", "state = \"estimate\"")
        .replace("noise = 1.5e-4", "noise = 1.5e-4\nbias = { sd = 3e-4 }");
    for (specification, on) in [(of_a_deflection, "p"), (of_two_angles, "twist")] {
        let (found, _) = answer_of(&specification, &dataset, |p, rate| {
            contact_torque(p - CENTRE, rate)
        });
        let effects = found["effects"].as_array().expect("a list");
        // An encoder bias is an equivalent effect.
        let names = class_names(&effects[0]);
        assert_eq!(names[0], format!("asymmetric_backlash {on}"), "{found:#}");
        let mut others = names[1..].iter();
        assert!(
            others.all(|name| name.starts_with("sensor_bias ")),
            "{names:?}"
        );
        let middle = &effects[0]["parameters"]["d_b"];
        let off = middle["value"].as_f64().map(|value| (value - CENTRE).abs());
        assert!(off.is_some_and(|off| off < 2e-3), "{middle:#}");
    }
}
