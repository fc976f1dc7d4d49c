//! Tests of records with a given motion and measured torques, as in start-stop and constant-speed runs. The torques of
//! an arm with two joints are computed by hand-written inverse dynamics.

use eomgen_tests::logistic_noise::LogisticNoise;
use eomgen_tests::program;
use serde_json::Value;
use tempfile::TempDir;

const ARM: &str = r#"
[model]
name = "arm"

[parameters]
m_1 = { value = 2.0, unit = "kg" }
m_2 = { value = 1.5, unit = "kg" }
l_1 = { value = 0.4, unit = "m" }
l_2 = { value = 0.3, unit = "m" }
g   = { value = 9.81, unit = "m/s^2" }

[coordinates]
q_1 = { unit = "rad" }
q_2 = { unit = "rad" }

[inputs]
tau_1 = { unit = "N m" }
tau_2 = { unit = "N m" }

[definitions]
x_1 = "l_1*cos(q_1)"
y_1 = "l_1*sin(q_1)"
x_2 = "x_1 + l_2*cos(q_1 + q_2)"
y_2 = "y_1 + l_2*sin(q_1 + q_2)"

[kinetic]
first  = "1/2*m_1*(dot(x_1)^2 + dot(y_1)^2)"
second = "1/2*m_2*(dot(x_2)^2 + dot(y_2)^2)"

[potential]
weight = "g*(m_1*y_1 + m_2*y_2)"

[forces]
motor_1 = { on = "q_1", value = "tau_1" }
motor_2 = { on = "q_2", value = "tau_2" }
"#;

const DATASET: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]

[time]
column = "t"
unit = "s"

[motion.q_1]
column = "q_1"
unit = "rad"

[motion.q_2]
column = "q_2"
unit = "mrad"

[channels.first]
column = "u_1"
unit = "N m"
noise = 0.05
observable = "tau_1"

[channels.tau_2]
column = "u_2"
unit = "N m"
noise = 0.03

[uncertain]
m_1 = { relative = 0.05 }
m_2 = { relative = 0.05 }
"#;

const SAMPLES: u32 = 1500;
const STEP: f64 = 0.004;

/// Returns a fifth-degree polynomial for a motion from rest to rest in 1.5 s, with its first and second derivatives.
fn ramp(t: f64) -> [f64; 3] {
    let s = (t / 1.5).clamp(0.0, 1.0);
    [
        s.powi(3) * (10.0 + s * (6.0 * s - 15.0)),
        30.0 * s * s * (s - 1.0).powi(2) / 1.5,
        60.0 * s * (s - 1.0) * (2.0 * s - 1.0) / (1.5 * 1.5),
    ]
}

/// Returns a joint's angle with its first and second derivatives: oscillations plus a motion to and fro with a pause.
fn joint(t: f64, swing: f64, way: f64) -> [f64; 3] {
    let (w, turn) = (2.7, 0.4);
    let (forth, back) = (ramp(t - 0.5), ramp(t - 3.0));
    let swings = [
        (w * t + turn).sin(),
        w * (w * t + turn).cos(),
        -w * w * (w * t + turn).sin(),
    ];
    std::array::from_fn(|kind| swing * swings[kind] + way * (forth[kind] - back[kind]))
}

/// Returns a record of the arm with dry friction in its second joint, N m, and encoders of this
/// noise, rad.
fn record(friction: f64, encoders: f64, turn: f64) -> String {
    let (m_1, m_2, l_1, l_2, g) = (2.02, 1.47, 0.4_f64, 0.3_f64, 9.81);
    let mut noise = LogisticNoise::new(1.0, 0.3 + 0.1 * turn);
    let mut text = "t,q_1,q_2,u_1,u_2\n".to_owned();
    for sample in 0..SAMPLES {
        let t = STEP * f64::from(sample);
        let [p, v_p, a_p] = joint(t, 0.5 + 0.1 * turn, 0.7);
        // The second joint oscillates or moves from rest to rest.
        let [q, v_q, a_q] = match turn > 0.5 {
            true => joint(t, 0.9, -0.4),
            false => joint(t, 0.0, 1.3),
        };
        let (c, s) = (q.cos(), q.sin());
        let (own, both, coupled) = (m_1 * l_1 * l_1, m_2 * l_2 * l_2, m_2 * l_1 * l_2);
        let weight_2 = m_2 * g * l_2 * (p + q).cos();
        let u_1 = (own + m_2 * l_1 * l_1 + both + 2.0 * coupled * c) * a_p
            + (both + coupled * c) * a_q
            - coupled * s * (2.0 * v_p * v_q + v_q * v_q)
            + (m_1 + m_2) * g * l_1 * p.cos()
            + weight_2;
        // During sticking, the friction is a fraction of its level.
        let rubbing = match v_q == 0.0 {
            true => 0.4 * friction,
            false => friction * v_q.signum(),
        };
        let u_2 =
            both * a_q + (both + coupled * c) * a_p + coupled * s * v_p * v_p + weight_2 + rubbing;
        let mut seen = |value: f64, sd: f64| value + sd * noise.draw();
        text += &format!(
            "{t:.4},{:.12},{:.9},{:.6},{:.6}\n",
            seen(p, encoders),
            1e3 * seen(q, encoders),
            seen(u_1, 0.05),
            seen(u_2, 0.03)
        );
    }
    text
}

fn write_files(specification: &str, dataset: &str, [train, test]: [String; 2]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in [
        ("spec.toml", specification),
        ("dataset.toml", dataset),
        ("train.csv", &train),
        ("test.csv", &test),
    ] {
        std::fs::write(folder.path().join(name), text).expect("a file");
    }
    folder
}

fn write_arm_records(friction: f64, encoders: f64, dataset: &str) -> TempDir {
    let records = [0.0, 1.0].map(|turn| record(friction, encoders, turn));
    write_files(ARM, dataset, records)
}

fn run_on_folder(command: &str, folder: &TempDir) -> Value {
    let paths = ["spec.toml", "dataset.toml", "out"].map(|name| folder.path().join(name));
    let answer = program::run_on_dataset(command, paths.each_ref());
    let page = folder.path().join("out/report.html");
    let page = std::fs::read_to_string(page).expect("a page");
    assert!(
        page.contains("first") && !page.contains("NaN"),
        "{answer:#}"
    );
    answer
}

fn discover(friction: f64, encoders: f64, dataset: &str) -> Value {
    run_on_folder("discover", &write_arm_records(friction, encoders, dataset))
}

/// Asserts that the only effect is dry friction of 0.6 N m in the second joint.
fn assert_friction_found(found: &Value, within: f64) {
    let effects = found["effects"].as_array().expect("effects");
    assert_eq!(effects.len(), 1, "{found:#}");
    let first = &effects[0];
    let place = ["effect", "on", "status"].map(|key| first[key].as_str().unwrap_or_default());
    assert_eq!(place, ["coulomb_friction", "q_2", "named"], "{first:#}");
    let size = first["parameters"]["T_c"]["value"].as_f64();
    assert!(
        size.is_some_and(|size| (size - 0.6).abs() < within),
        "{first:#}"
    );
    assert!(
        found["closure"]["test"]
            .as_f64()
            .is_some_and(|part| part > 0.95),
        "{found:#}"
    );
}

#[test]
fn friction_torque_of_a_joint_is_found() {
    let found = discover(0.6, 0.0, DATASET);
    assert_friction_found(&found, 0.01);
    let notes = found["notes"].to_string();
    let said = "of 1500 samples of `tau_2` are ignored: the friction force at rest";
    assert!(notes.contains(said), "{notes}");
    // The masses in the specification are wrong by two percent; their weight makes this visible.
    let masses = found["refitted"].to_string();
    assert!(masses.contains("m_1") && masses.contains("m_2"), "{masses}");
}

#[test]
fn noisy_encoders_are_handled_by_averaging_samples() {
    let averaged = DATASET.replace("unit = \"s\"", "unit = \"s\"\nevery = 5");
    assert_friction_found(&discover(0.6, 2e-6, &averaged), 0.02);
    // Without averaging, the noise of the motion would cause more torque noise than the torque sensors.
    let said = "noise of the motion causes noise of";
    let notes = |dataset: &str| {
        let compared = run_on_folder("compare", &write_arm_records(0.6, 2e-6, dataset));
        compared["notes"].to_string()
    };
    assert!(notes(DATASET).contains(said) && !notes(&averaged).contains(said));
}

#[test]
fn torque_ripple_of_unusual_order_is_found_at_constant_speed() {
    // The ripple of a motor with seven pole pairs has fourteen periods per revolution.
    let rotor = |turn: f64| {
        let mut noise = LogisticNoise::new(0.01, 0.2 + 0.1 * turn);
        let mut text = "t,q,u\n".to_owned();
        for sample in 0..2000 {
            let t = 0.004 * f64::from(sample);
            let [start, v_start, a_start] = ramp(t);
            let speed = 3.0 + turn;
            let (q, v) = (speed * t * start, speed * (start + t * v_start));
            let a = speed * (2.0 * v_start + t * a_start);
            let torque = 0.05 * a + 0.02 * v + 0.06 * (14.0 * q + 0.7).sin();
            text += &format!("{t:.4},{q:.12},{:.6}\n", torque + noise.draw());
        }
        text
    };
    let specification = "[model]\nname = \"rotor\"\n[parameters]\nJ = { value = 0.05, unit = \"kg m^2\" }\n\
        c = { value = 0.02, unit = \"N m s/rad\" }\n[coordinates]\nq = { unit = \"rad\" }\n[inputs]\ntau = { unit = \"N m\" }\n\
        [kinetic]\nrotor = \"1/2*J*dot(q)^2\"\n[dissipation]\nbearing = \"1/2*c*dot(q)^2\"\n\
        [forces]\nmotor = { on = \"q\", value = \"tau\" }\n";
    let dataset = "[records]\ntrain = [\"train.csv\"]\ntest = [\"test.csv\"]\n[time]\ncolumn = \"t\"\nunit = \"s\"\n\
        [motion.q]\ncolumn = \"q\"\nunit = \"rad\"\n[channels.tau]\ncolumn = \"u\"\nunit = \"N m\"\nnoise = 0.01\n\
        [uncertain]\nc = { relative = 0.3 }\n";
    let folder = write_files(specification, dataset, [0.0, 1.0].map(rotor));
    let paths = ["spec.toml", "dataset.toml", "out"].map(|name| folder.path().join(name));
    let found = program::run_on_dataset("discover", paths.each_ref());
    let effects = found["effects"].as_array().expect("effects");
    assert_eq!(effects.len(), 1, "{found:#}");
    assert_eq!(effects[0]["effect"], "torque_ripple", "{found:#}");
    assert_eq!(effects[0]["order"]["order"], 14, "{found:#}");
}

#[test]
fn complete_model_gives_no_effect() {
    let found = discover(0.0, 0.0, DATASET);
    assert_eq!(found["verdict"], "no_significant_gap", "{found:#}");
}

const PENDULUM: &str = r#"
[model]
name = "pendulum"
[parameters]
m = { value = 1.9, unit = "kg" }
l = { value = 0.42, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
c = { value = 0.05, unit = "N m s" }
[coordinates]
q = { unit = "rad" }
[inputs]
u = { unit = "N m" }
[kinetic]
bob = "1/2*m*l^2*dot(q)^2"
[potential]
weight = "-m*g*l*cos(q)"
[dissipation]
pivot = "1/2*c*dot(q)^2"
[forces]
motor = { on = "q", value = "u" }
"#;

const TORQUE: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]
[time]
column = "t"
unit = "s"
[motion.q]
column = "q"
unit = "rad"
[channels.tau]
column = "u"
unit = "N m"
noise = 0.02
observable = "u"
[uncertain]
c = { relative = 0.1 }
"#;

/// Returns the effects found in records of a swinging pendulum. `swing` is the amplitude of the angle and `step` the
/// time between samples. `added` is a torque that the model lacks, a function of angle, rate and acceleration.
fn find_on_pendulum(swing: f64, step: f64, added: fn([f64; 3]) -> f64) -> Vec<Value> {
    let record = |turn: f64| {
        let mut noise = LogisticNoise::new(0.02, 0.2 + 0.1 * turn);
        let mut text = "t,q,u\n".to_owned();
        for sample in 0..(4.0 / step) as u32 {
            let t = step * f64::from(sample);
            let waves = [(0.7, 2.1, 0.0), (0.4, 5.3, 1.0 + turn), (0.1, 11.0, 2.0)];
            let motion = waves.map(|(size, w, phase)| {
                let (sine, cosine) = (w * t + phase + turn).sin_cos();
                [size * sine, size * w * cosine, -size * w * w * sine]
            });
            let [q, v, a]: [f64; 3] =
                std::array::from_fn(|kind| swing * motion.iter().map(|of| of[kind]).sum::<f64>());
            let inertia = 1.9 * 0.42 * 0.42;
            let torque = inertia * a + 0.05 * v + 1.9 * 9.81 * 0.42 * q.sin() + added([q, v, a]);
            text += &format!("{t:.3},{q:.12},{:.6}\n", torque + noise.draw());
        }
        text
    };
    let folder = write_files(PENDULUM, TORQUE, [0.0, 1.0].map(record));
    let paths = ["spec.toml", "dataset.toml", "out"].map(|name| folder.path().join(name));
    let found = program::run_on_dataset("discover", paths.each_ref());
    found["effects"].as_array().expect("effects").clone()
}

#[test]
fn both_effects_of_a_pair_form_classes_with_parameters() {
    // An inertia without weight is equivalent to a heavier bob with less gravity.
    let effects = find_on_pendulum(1.0, 0.005, |[_, _, a]| 0.2 * 1.9 * 0.42 * 0.42 * a);
    let of = |effect: &str| {
        let mut all = effects.iter();
        let found = all.find(|found| found["effect"] == effect);
        found.unwrap_or_else(|| panic!("{effect}: {effects:#?}"))
    };
    let is_in_class = |of: &Value, effect: &str, on: &str| {
        let mut class = of["equivalent"].as_array().expect("a list").iter();
        assert_eq!(of["status"], "class", "{of:#}");
        assert!(
            class.any(|other| other["effect"] == effect && other["on"] == on),
            "{of:#}"
        );
    };
    is_in_class(of("gravity"), "parameter_shift", "g");
    is_in_class(of("sensor_gain"), "parameter_shift", "m");
    is_in_class(of("sensor_gain"), "input_gain", "u");
}

#[test]
fn inseparable_orders_of_a_ripple_form_a_class() {
    // The record covers only slightly more than one period of the ripple.
    let effects = find_on_pendulum(0.15, 0.02, |[q, _, _]| 0.06 * (24.0 * q + 0.4).cos());
    assert_eq!(effects.len(), 1, "{effects:#?}");
    let ripple = &effects[0];
    assert_eq!(ripple["effect"], "torque_ripple", "{ripple:#}");
    assert_eq!(ripple["status"], "class", "{ripple:#}");
    let class = ripple["equivalent"].as_array().expect("a list");
    let orders = class.iter().chain([ripple]);
    let orders: Vec<u64> = orders
        .filter_map(|of| of["order"]["order"].as_u64())
        .collect();
    assert!(orders.contains(&24) && orders.len() > 1, "{orders:?}");
}
