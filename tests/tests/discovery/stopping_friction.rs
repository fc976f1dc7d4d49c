//! Test that dry friction that stops a pendulum is found with name, site and value. The records are from set-valued
//! time stepping that shares no code with the simulator.

use eomgen_tests::program;
use serde_json::Value;

const M: f64 = 0.15;
const L: f64 = 0.3;
const G: f64 = 9.81;
const C: f64 = 2e-3;
const T_C: f64 = 0.03;

/// Standard deviation of the encoder, rad.
const NOISE: f64 = 1e-3;

/// Time between samples, s.
const SAMPLE: f64 = 0.005;

const SPECIFICATION: &str = r#"
[model]
name = "pendulum"

[parameters]
m = { value = 0.15, unit = "kg", min = 0 }
l = { value = 0.3, unit = "m", min = 0 }
g = { value = 9.81, unit = "m/s^2" }
c = { value = 2e-3, unit = "N m s", min = 0 }

[coordinates]
theta = { unit = "rad", doc = "from hanging down" }

[inputs]
u = { unit = "N m", doc = "torque at the pivot" }

[kinetic]
bob = "1/2*m*l^2*dot(theta)^2"

[potential]
gravity = "-m*g*l*cos(theta)"

[dissipation]
pivot = "1/2*c*dot(theta)^2"

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
unit = "N m"

[channels.theta]
column = "theta"
unit = "rad"
noise = 1e-3

[uncertain]
c = { relative = 0.1 }

[windows]
length = 0.5
"#;

/// Generator of approximately normal numbers: sums of twelve uniform numbers.
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

/// Returns a record from rest at an angle, and the total time at rest, s. In each short step, the friction impulse
/// brings the speed as close to zero as the bounds of the friction permit.
fn record(angle: f64, torque: impl Fn(f64) -> f64, until: f64, seed: u64) -> (String, f64) {
    let (inertia, parts) = (M * L * L, 100);
    let h = SAMPLE / f64::from(parts);
    let (mut q, mut v, mut stood) = (angle, 0.0_f64, 0.0);
    let mut noise = Noise(seed);
    let mut text = "t,u,theta\n".to_owned();
    for sample in 0..=(until / SAMPLE).round() as u32 {
        let t = f64::from(sample) * SAMPLE;
        let u = torque(t);
        text += &format!("{t:.6},{u:.12e},{:.12e}\n", q + NOISE * noise.next());
        for _ in 0..parts {
            let middle = q + 0.5 * h * v;
            let force = u - M * G * L * middle.sin() - C * v;
            let free = v + h * force / inertia;
            let most = h * T_C / inertia;
            let next = free - free.clamp(-most, most);
            q += 0.5 * h * (v + next);
            v = next;
            stood += if v == 0.0 { h } else { 0.0 };
        }
    }
    (text, stood)
}

fn discover(records: [(String, f64); 2]) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    let write = |name: &str, text: &str| std::fs::write(place(name), text).expect("a file");
    write("pendulum.toml", SPECIFICATION);
    write("dataset.toml", DATASET);
    for (name, (text, stood)) in ["train.csv", "test.csv"].iter().zip(&records) {
        assert!(*stood > 0.5, "{name}: {stood} s at rest");
        write(name, text);
    }
    let paths = ["pendulum.toml", "dataset.toml", "found"].map(place);
    program::run_on_dataset("discover", paths.each_ref())
}

fn assert_friction_found(found: &Value) {
    let effects = found["effects"].as_array().expect("effects");
    assert_eq!(effects.len(), 1, "{found:#}");
    let effect = &effects[0];
    assert_eq!(effect["effect"], "coulomb_friction", "{effect:#}");
    assert_eq!(effect["on"], "theta", "{effect:#}");
    assert_eq!(effect["status"], "named", "{effect:#}");
    let size = &effect["parameters"]["T_c"];
    let [value, sd] = ["value", "sd"].map(|key| size[key].as_f64().expect("a number"));
    assert!((value / T_C - 1.0).abs() < 0.03, "{value}");
    assert!((value - T_C).abs() < 4.0 * sd, "{value} {sd}");
    let closed = found["closure"]["test"].as_f64().expect("a number");
    assert!(closed > 0.98, "{closed}");
}

#[test]
fn friction_of_released_pendulum_is_found() {
    let released = |angle, seed| record(angle, |_| 0.0, 4.0, seed);
    assert_friction_found(&discover([released(1.0, 1), released(0.8, 2)]));
}

#[test]
fn friction_of_sticking_pendulum_is_found() {
    let driven = |torque: f64, period: f64, seed| {
        let turn = std::f64::consts::TAU / period;
        record(0.0, |t| torque * (turn * t).sin(), 8.0, seed)
    };
    assert_friction_found(&discover([driven(0.06, 4.0, 3), driven(0.07, 3.0, 4)]));
}
