//! Tests of friction proportional to the load of a shaft, in a drive of two masses with hand-written equations. The
//! effect is found on the shaft with friction, and it is distinguished from friction of constant level.

use eomgen_tests::logistic_noise::LogisticNoise;
use eomgen_tests::program;
use serde_json::Value;

const DRIVE: &str = r#"
[model]
name = "drive"

[parameters]
J_m = { value = 1e-3, unit = "kg m^2" }
J_l = { value = 5e-3, unit = "kg m^2" }
k   = { value = 20, unit = "N m/rad" }
d   = { value = 0.01, unit = "N m s/rad" }

[coordinates]
theta_m = { unit = "rad" }
theta_l = { unit = "rad" }

[inputs]
u = { unit = "N m" }

[kinetic]
motor = "1/2*J_m*dot(theta_m)^2"
load  = "1/2*J_l*dot(theta_l)^2"

[potential]
shaft = "1/2*k*(theta_m - theta_l)^2"

[dissipation]
shaft = "1/2*d*(dot(theta_m) - dot(theta_l))^2"

[forces]
drive = { on = "theta_m", value = "u" }
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
unit = "N m"

[channels.theta_m]
column = "m"
unit = "rad"
noise = 5e-4

[channels.theta_l]
column = "l"
unit = "rad"
noise = 5e-4

[initial]
state = "rest"

[uncertain]
k = { relative = 0.05 }
d = { relative = 0.3 }

[windows]
length = 0.5
"#;

/// Returns a record of the drive. The friction of the motor's bearing is `per_load` times the shaft
/// torque plus `constant`, N m.
fn record(per_load: f64, constant: f64, turn: f64) -> String {
    let (j_m, j_l, k, d) = (1e-3, 5e-3, 20.0, 0.01);
    let parts = 100;
    let h = 0.002 / f64::from(parts);
    let (mut m, mut l, mut w_m, mut w_l) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let mut noise = LogisticNoise::new(5e-4, 0.3 + 0.1 * turn);
    let mut text = "t,u,m,l\n".to_owned();
    for sample in 0..1500 {
        let t = 0.002 * f64::from(sample);
        let u = 0.5 * (6.0 * t + turn).cos()
            + 0.3 * (17.0 * t * (1.0 + 0.2 * turn)).sin()
            + 0.1 * (61.0 * t).sin();
        let seen = [m, l].map(|angle| angle + noise.draw());
        text += &format!("{t:.4},{u:.10},{:.9},{:.9}\n", seen[0], seen[1]);
        for _ in 0..parts {
            let twist = k * (m - l);
            let transmitted = twist + d * (w_m - w_l);
            let rubbing = (per_load * twist.abs() + constant) * (w_m / 1e-3).tanh();
            w_m += h * (u - transmitted - rubbing) / j_m;
            w_l += h * transmitted / j_l;
            m += h * w_m;
            l += h * w_l;
        }
    }
    text
}

fn discover(per_load: f64, constant: f64) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name);
    let [train, test] = [0.0, 1.0].map(|turn| record(per_load, constant, turn));
    for (name, text) in [
        ("drive.toml", DRIVE),
        ("dataset.toml", DATASET),
        ("train.csv", &train),
        ("test.csv", &test),
    ] {
        std::fs::write(file(name), text).expect("a file");
    }
    let paths = ["drive.toml", "dataset.toml", "out"].map(file);
    program::run_on_dataset("discover", paths.each_ref())
}

/// Asserts that this effect on the motor's shaft is the only one, and that its parameter is close to `size`.
fn assert_only(found: &Value, effect: &str, parameter: &str, size: f64) {
    let effects = found["effects"].as_array().expect("effects");
    assert_eq!(effects.len(), 1, "{effects:#?}");
    let first = &effects[0];
    assert_eq!(first["effect"], effect, "{first:#}");
    assert_eq!(first["on"], "theta_m", "{first:#}");
    assert_eq!(first["status"], "named", "{first:#}");
    let value = first["parameters"][parameter]["value"].as_f64();
    let is_near = value.is_some_and(|value| (value - size).abs() < 0.01 * size);
    assert!(is_near, "{first:#}");
}

#[test]
fn load_dependent_friction_of_the_shaft_is_found() {
    let found = discover(0.15, 0.0);
    assert_only(&found, "load_dependent_friction", "mu", 0.15);
    assert_eq!(found["effects"][0]["load"], "shaft", "{found:#}");
}

#[test]
fn constant_friction_is_not_reported_as_load_dependent() {
    assert_only(&discover(0.0, 0.05), "coulomb_friction", "T_c", 0.05);
}
